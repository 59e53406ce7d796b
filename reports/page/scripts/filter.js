const wanted = { live: '', experience: '', setting: '' };
const switchedOff = new WeakMap();
const isShown = id => {
  const cell = cells.get(id);
  return !cell || Object.entries(wanted).every(([what, value]) => value === '' || cell[what] === value);
};
const cellsOf = e => (e.dataset.cells || e.dataset.cell || '').split(' ').filter(Boolean);

const refreshChart = svg => {
  const off = switchedOff.get(svg) || new Set();
  const seen = new Map();
  let any = false, own = false;
  for (const e of $$('.stage [data-s], .stage [data-cell], .stage [data-cells]', svg)) {
    const filtered = !cellsOf(e).every(isShown);
    e.classList.toggle('off', filtered || off.has(e.dataset.s));
    if (e.dataset.s) seen.set(e.dataset.s, seen.get(e.dataset.s) || !filtered);
    own ||= cellsOf(e).length > 0;
    any ||= !filtered && cellsOf(e).length > 0;
  }
  for (const button of $$('.switches button', svg.parentElement)) {
    button.hidden = seen.get(button.dataset.key) === false;
    button.setAttribute('aria-pressed', String(!off.has(button.dataset.key)));
  }
  const box = svg.closest('.panel, .wide');
  if (box) box.classList.toggle('off', own && !any);
};

const refresh = () => {
  charts.forEach(refreshChart);
  let shown = 0;
  for (const row of $$('tr[data-cell]')) {
    row.classList.toggle('off', !isShown(row.dataset.cell));
    shown += isShown(row.dataset.cell);
  }
  for (const e of $$('details[data-cell]')) e.classList.toggle('off', !isShown(e.dataset.cell));
  const text = `${shown} of ${data.cells.length} cells shown`;
  $('#filter output').textContent = text;
  $('#filter .reset').disabled = Object.values(wanted).every(value => value === '');
  say(text);
};

const filter = $('#filter');
for (const what of Object.keys(wanted)) {
  const values = [...new Set(data.cells.map(cell => cell[what]))];
  const select = $(`#filter-${what}`);
  select.append(...values.map(value => make('option', { value, textContent: value.length > 60 ? `${value.slice(0, 59)}…` : value })));
  select.closest('label').hidden = values.length < 2;
  select.addEventListener('change', () => { wanted[what] = select.value; refresh(); });
}
filter.hidden = data.cells.length < 2;
filter.addEventListener('submit', event => event.preventDefault());
$('.reset', filter).addEventListener('click', () => {
  for (const what of Object.keys(wanted)) wanted[what] = $(`#filter-${what}`).value = '';
  refresh();
});

// The drawn legend becomes buttons below the chart, and is drawn again on paper.
for (const svg of charts.filter(svg => $('[data-key]', svg))) {
  const [, , width, whole] = numbers(svg.getAttribute('viewBox'));
  const crop = height => { svg.setAttribute('viewBox', `0 0 ${width} ${height}`); svg.setAttribute('height', height); };
  const screen = () => { $('.legend', svg).classList.add('off'); crop(+svg.dataset.legend); };
  const row = make('div', { className: 'switches' });
  row.setAttribute('role', 'group');
  row.setAttribute('aria-label', `Series of ${$('title', svg).textContent}`);
  for (const key of $$('.key', svg)) {
    const text = $('text', key), box = key.getBBox(), glyph = document.createElementNS(SVG, 'svg');
    const left = text.getAttribute('x') - 30;
    glyph.setAttribute('viewBox', `${left} ${box.y - 2} 28 ${box.height + 4}`);
    glyph.setAttribute('class', 'chart glyph');
    glyph.setAttribute('aria-hidden', 'true');
    glyph.append(...[...key.children].filter(e => e !== text).map(e => e.cloneNode(true)));
    const name = make('bdi', { className: 'name', textContent: $('title', text)?.textContent || text.textContent });
    const of = key.dataset.key;
    const entry = make(of === undefined ? 'span' : 'button', { className: 'key' }, glyph, name);
    row.append(entry);
    if (of === undefined) continue;
    entry.type = 'button';
    entry.dataset.key = of;
    entry.setAttribute('aria-pressed', 'true');
    entry.addEventListener('click', () => {
      const off = switchedOff.get(svg) || new Set();
      if (!off.delete(of)) off.add(of);
      switchedOff.set(svg, off);
      refreshChart(svg);
    });
  }
  svg.after(row);
  screen();
  addEventListener('beforeprint', () => { $('.legend', svg).classList.remove('off'); crop(whole); });
  addEventListener('afterprint', screen);
}
