const tip = make('div', { id: 'tip', hidden: true });
document.body.append(tip);

// The mark under the pointer: the nearest element of a plot that says what it is.
const ownerOf = target => {
  for (let e = target; e && e.closest && e.closest('.stage') && !e.classList.contains('stage'); e = e.parentElement) {
    const title = [...e.children].find(child => child.localName === 'title');
    if (title) {
      // Moved, so that the browser does not show it a second time.
      e.dataset.tip = title.textContent;
      title.remove();
    }
    if (e.dataset.tip && e.localName !== 'text') return e;
  }
  return null;
};

// What a curve says at some x: the values of its nearest point.
const onCurve = (e, x) => {
  const d = numbers(e.dataset.d), p = numbers(e.dataset.p);
  if (!d || !p || d.length !== p.length || d.length < 2) return null;
  const at = valueAt(e.ownerSVGElement, x);
  let i = 0;
  while (i + 1 < d.length && Math.abs(d[i + 1] - at) <= Math.abs(d[i] - at)) i += 1;
  return { d: d[i], text: `at d = ${d[i]} m: ${(100 * p[i]).toFixed(1)} %` };
};

const textOf = (e, x) => {
  const curve = x === undefined ? null : onCurve(e, x);
  return curve ? `${e.dataset.tip}; ${curve.text}` : e.dataset.tip;
};

const showTip = (e, x, y, text) => {
  const svg = e.ownerSVGElement;
  const heading = svg.getAttribute('aria-label') || $('title', svg).textContent;
  tip.replaceChildren(make('b', { textContent: heading }), make('span', { textContent: text }));
  tip.hidden = false;
  const box = tip.getBoundingClientRect();
  tip.style.left = `${Math.max(6, Math.min(x + 14, innerWidth - box.width - 6))}px`;
  tip.style.top = `${y + 18 + box.height > innerHeight ? Math.max(6, y - box.height - 12) : y + 18}px`;
};
const hideTip = () => { tip.hidden = true; };

document.addEventListener('pointermove', event => {
  const e = ownerOf(event.target);
  if (!e) return hideTip();
  showTip(e, event.clientX, event.clientY, textOf(e, unitsAt(e.ownerSVGElement, event.clientX, event.clientY).x));
});
for (const moved of ['wheel', 'touchmove']) document.addEventListener(moved, hideTip, { passive: true });

// One stop of the Tab key per chart; inside, arrows walk from mark to mark.
const walkable = svg => $$('.stage path, .stage g', svg)
  .filter(e => (e.dataset.tip || $('title', e)) && !e.classList.contains('band') && !e.closest('.off') && ownerOf(e) === e)
  .sort((a, b) => a.classList.contains('line') - b.classList.contains('line'));

const walk = (svg, step) => {
  const marks = walkable(svg);
  if (!marks.length) return;
  const before = marks.indexOf($('.here', svg));
  const at = before < 0 ? (step > 0 ? 0 : marks.length - 1) : (before + step + marks.length) % marks.length;
  if (before >= 0) marks[before].classList.remove('here');
  marks[at].classList.add('here');
  const box = marks[at].getBoundingClientRect();
  showTip(marks[at], box.x + box.width / 2, box.y + box.height / 2, textOf(marks[at]));
  say(textOf(marks[at]));
};

for (const svg of charts) {
  // Some charts are drawn without marks to walk to; they are still pictures that can be zoomed.
  svg.setAttribute('role', 'group');
  svg.tabIndex = 0;
  svg.setAttribute('aria-keyshortcuts', 'ArrowLeft ArrowRight Enter + - 0');
  svg.addEventListener('keydown', event => {
    const here = $('.here', svg);
    if (['ArrowRight', 'ArrowDown'].includes(event.key)) walk(svg, 1);
    else if (['ArrowLeft', 'ArrowUp'].includes(event.key)) walk(svg, -1);
    else if (event.key === '+' || event.key === '=') zoomBy(svg, 1.6, here);
    else if (event.key === '-') zoomBy(svg, 1 / 1.6, here);
    else if (event.key === '0') resetZoom(svg);
    else if (event.key === 'Escape') hideTip();
    else if (event.key === 'Enter' && here) openFrom(here);
    else return;
    event.preventDefault();
  });
  svg.addEventListener('blur', () => {
    hideTip();
    $$('.here', svg).forEach(e => e.classList.remove('here'));
  });
}
