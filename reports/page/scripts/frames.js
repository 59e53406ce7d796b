const dialog = $('#frame');
let shownFrame = null;

const stampOf = (traversal, i) => String(BigInt(traversal.first_ns) + BigInt(traversal.after_ns[i]));
const nearest = (metres, to, allowed) => {
  let best = -1;
  metres.forEach((m, i) => { if (allowed(i) && (best < 0 || Math.abs(m - to) < Math.abs(metres[best] - to))) best = i; });
  return best;
};
const picturesOf = (cell, stamp) => $$('main .tiles figure')
  .filter(tile => tile.dataset.stamp === stamp && cells.get(tile.dataset.cell)?.traversal === cell.traversal)
  .sort((a, b) => (b.dataset.cell === cell.id) - (a.dataset.cell === cell.id));

const showFrame = (cell, i, note = '') => {
  const traversal = data.traversals[cell.traversal], frames = cell.frames, metres = traversal.metres[i], stamp = stampOf(traversal, i);
  shownFrame = { cell, i };
  const lost = cell.lost.find(([from, to]) => metres > from && metres < to);
  const correct = { 1: ', the right place', 0: ', the wrong place' }[frames.correct[i]] || '';
  const node = frames.node[i];
  const facts = [
    ['Live', cell.live], ['Experience', cell.experience], ['Frame', `${i + 1} of ${traversal.metres.length}, at ${metres.toFixed(1)} m`],
    ['Stamp', `${stamp} ns`], ['Decision', data.decisions[+frames.decision[i]] + correct],
    ['Inliers', frames.inliers[i] === null ? 'not verified' : `${frames.inliers[i]} (threshold ${cell.threshold})`],
    ['Node', node === null ? 'none' : `stamp ${data.nodes[node]} ns`],
    ['State', lost ? `lost from ${lost[0].toFixed(1)} to ${lost[1].toFixed(1)} m` : 'localised'],
  ];
  $('.facts', dialog).replaceChildren(...facts.map(([name, value]) => make('div', {}, make('dt', { textContent: name }), make('dd', {}, make('bdi', { textContent: value })))));
  $('.note', dialog).textContent = note;
  const pictures = picturesOf(cell, stamp);
  $('.tiles', dialog).replaceChildren(...pictures.map(tile => {
    const copy = tile.cloneNode(true);
    for (const e of [copy, ...$$('[id], [aria-labelledby]', copy)]) {
      e.removeAttribute('id');
      if (e.hasAttribute('aria-labelledby')) e.setAttribute('aria-label', $('title', e)?.textContent || 'frame');
      e.removeAttribute('aria-labelledby');
    }
    return copy;
  }));
  $('.none', dialog).hidden = pictures.length > 0;
  $('.back', dialog).disabled = i === 0;
  $('.on', dialog).disabled = i + 1 >= traversal.metres.length;
  if (!dialog.open) dialog.showModal();
};

// The frame that a mark stands for: on a lane the nearest one, on a lost-distance curve the one at which the stretch ends.
const openFrom = (e, x) => {
  const cell = cells.get(e.dataset.cell);
  if (!cell) return;
  if (!cell.frames || cell.traversal === null) return say('This page has too many cells to include the frames of this one.');
  const traversal = data.traversals[cell.traversal], at = x === undefined ? undefined : valueAt(e.ownerSVGElement, x);
  const accepted = i => cell.frames.decision[i] === '0';
  const wrong = i => accepted(i) && cell.frames.correct[i] === '0';
  if (e.dataset.wrong) return showFrame(cell, nearest(traversal.metres, +e.dataset.m, wrong));
  const d = e.dataset.p === undefined ? undefined : onCurve(e, x)?.d ?? +e.dataset.d;
  if (d !== undefined && !Number.isNaN(d)) {
    const stretch = cell.lost.filter(([from, to]) => to - from >= d).sort((a, b) => (a[1] - a[0]) - (b[1] - b[0]))[0];
    if (!stretch) return say(`No lost stretch is longer than ${d} m.`);
    const note = `The shortest lost stretch of at least ${d} m: from ${stretch[0].toFixed(1)} to ${stretch[1].toFixed(1)} m. It ends at this frame.`;
    return showFrame(cell, nearest(traversal.metres, stretch[1], () => true), note);
  }
  const first = Math.max(0, traversal.metres.findIndex((_, i) => accepted(i)));
  const onRoute = at !== undefined && at !== null && e.classList.contains('line') && e.closest('[id$=route-figure]');
  const found = onRoute ? nearest(traversal.metres, at, i => !e.dataset.m || accepted(i)) : first;
  showFrame(cell, found < 0 ? first : found);
};

document.addEventListener('click', event => {
  const e = dragged ? null : ownerOf(event.target);
  if (e?.dataset.cell) openFrom(e, unitsAt(e.ownerSVGElement, event.clientX, event.clientY).x);
});
const step = by => showFrame(shownFrame.cell, shownFrame.i + by);
$('.back', dialog).addEventListener('click', () => step(-1));
$('.on', dialog).addEventListener('click', () => step(1));
$('.pictured', dialog).addEventListener('click', () => {
  const { cell, i } = shownFrame, traversal = data.traversals[cell.traversal];
  const stamps = new Set($$('main .tiles figure').filter(tile => tile.dataset.cell === cell.id).map(tile => tile.dataset.stamp));
  const found = nearest(traversal.metres, traversal.metres[i], j => stamps.has(stampOf(traversal, j)));
  if (found < 0) say('No frame of this cell has an image on the page.');
  else showFrame(cell, found);
});
$('.close', dialog).addEventListener('click', () => dialog.close());

// A link into something folded opens it.
const unfold = () => {
  const target = location.hash.length > 1 && document.getElementById(decodeURIComponent(location.hash.slice(1)));
  for (let e = target; e; e = e.parentElement) if (e.localName === 'details') e.open = true;
  if (target) target.scrollIntoView();
};
addEventListener('hashchange', unfold);
unfold();
refresh();
