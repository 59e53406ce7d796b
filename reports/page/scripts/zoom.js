const SVG = 'http://www.w3.org/2000/svg';

const roundSteps = (from, to) => {
  const rough = (to - from) / 5, decade = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map(m => m * decade).find(s => s >= rough);
  const steps = [];
  for (let v = Math.ceil(from / step - 1e-9) * step; v <= to + step * 1e-6; v += step) steps.push(+v.toPrecision(8));
  return steps;
};

// Ticks of one axis where the view is now: numbers are chosen anew, names move.
const layTicks = (svg, axis, view) => {
  const group = $(`.ticks-${axis}`, svg), plot = plotOf(svg), flat = axis === 'x';
  group.drawn ||= [...group.children].map(e => ({ e, x: +e.getAttribute('x'), y: +e.getAttribute('y'), turned: e.getAttribute('transform') }));
  const [range, start, length, shift] = flat ? [plot.xs, plot.x, plot.w, view.x] : [plot.ys, plot.y + plot.h, -plot.h, view.y];
  const inside = p => flat ? p >= plot.x - 1 && p <= plot.x + plot.w + 1 : p >= plot.y - 1 && p <= plot.y + plot.h + 1;
  if (range && view.k > 1 && group.drawn.length) {
    const value = p => range[0] + ((p - shift) / view.k - start) / length * (range[1] - range[0]);
    const place = v => (start + (v - range[0]) / (range[1] - range[0]) * length) * view.k + shift;
    group.replaceChildren(...roundSteps(value(start), value(start + length)).map(v => {
      const text = group.drawn[0].e.cloneNode(false);
      text.setAttribute(flat ? 'x' : 'y', flat ? place(v) : place(v) + 4);
      text.textContent = String(v);
      return text;
    }));
    return;
  }
  group.replaceChildren(...group.drawn.map(drawn => drawn.e));
  for (const { e, x, y, turned } of group.drawn) {
    const [left, top] = turned ? turned.match(/-?[\d.]+/g).map(Number) : [x, y];
    const moved = flat ? left * view.k + view.x : (top - 4) * view.k + view.y + 4;
    e.classList.toggle('off', !inside(flat ? moved : moved - 4));
    if (turned) e.setAttribute('transform', `translate(${moved} ${top}) rotate(-45)`);
    else e.setAttribute(flat ? 'x' : 'y', moved);
  }
};

const look = (svg, view) => {
  const plot = plotOf(svg), stage = $('.stage', svg);
  view.k = Math.max(1, Math.min(view.k, 40));
  view.x = Math.max((plot.x + plot.w) * (1 - view.k), Math.min(view.x, plot.x * (1 - view.k)));
  view.y = Math.max((plot.y + plot.h) * (1 - view.k), Math.min(view.y, plot.y * (1 - view.k)));
  views.set(svg, view);
  const zoomed = view.k > 1;
  svg.classList.toggle('zoomed', zoomed);
  stage.style.setProperty('--inverse', 1 / view.k);
  if (zoomed) {
    stage.setAttribute('transform', `translate(${view.x} ${view.y}) scale(${view.k})`);
    stage.parentElement.setAttribute('clip-path', `url(#${$('clipPath', svg).id})`);
  } else {
    stage.removeAttribute('transform');
    stage.parentElement.removeAttribute('clip-path');
  }
  layTicks(svg, 'x', view);
  layTicks(svg, 'y', view);
  const reset = svg.parentElement.querySelector('.reset');
  if (reset) reset.disabled = !zoomed;
};

// Zooms about a mark, a place in the window, or the middle.
const zoomBy = (svg, factor, about) => {
  const plot = plotOf(svg), view = viewOf(svg);
  let at = { rawX: plot.x + plot.w / 2, rawY: plot.y + plot.h / 2 };
  if (about instanceof Element) {
    const box = about.getBoundingClientRect();
    at = unitsAt(svg, box.x + box.width / 2, box.y + box.height / 2);
  } else if (about) at = unitsAt(svg, about.clientX, about.clientY);
  const k = Math.max(1, Math.min(view.k * factor, 40)), part = k / view.k;
  look(svg, { k, x: at.rawX - (at.rawX - view.x) * part, y: at.rawY - (at.rawY - view.y) * part });
  hideTip();
};
const resetZoom = svg => { look(svg, { k: 1, x: 0, y: 0 }); hideTip(); };

let dragged = false;
for (const svg of charts) {
  const name = $('title', svg).textContent;
  const button = (text, label, className, act) => {
    const made = make('button', { type: 'button', textContent: text, className, title: label, onclick: act });
    made.setAttribute('aria-label', `${label}: ${name}`);
    return made;
  };
  const reset = button('Reset', 'Reset zoom', 'reset', () => resetZoom(svg));
  reset.disabled = true;
  svg.before(make('div', { className: 'tools' }, button('+', 'Zoom in', '', () => zoomBy(svg, 1.6)), button('−', 'Zoom out', '', () => zoomBy(svg, 1 / 1.6)), reset));
  svg.addEventListener('wheel', event => {
    // The wheel alone scrolls the page.
    if (!event.ctrlKey && !event.metaKey) return;
    event.preventDefault();
    zoomBy(svg, event.deltaY < 0 ? 1.25 : 0.8, event);
  }, { passive: false });
  let from = null;
  svg.addEventListener('pointerdown', event => {
    dragged = false;
    if (viewOf(svg).k > 1) from = { at: unitsAt(svg, event.clientX, event.clientY), view: viewOf(svg) };
  });
  addEventListener('pointermove', event => {
    if (!from) return;
    const at = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
    const [dx, dy] = [at.x - from.at.rawX, at.y - from.at.rawY];
    dragged ||= Math.hypot(dx, dy) > 3;
    if (dragged) look(svg, { k: from.view.k, x: from.view.x + dx, y: from.view.y + dy });
  });
  addEventListener('pointerup', () => { from = null; });
}
