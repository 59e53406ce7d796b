const $ = (selector, from = document) => from.querySelector(selector);
const $$ = (selector, from = document) => [...from.querySelectorAll(selector)];
const make = (tag, properties = {}, ...children) => {
  const element = Object.assign(document.createElement(tag), properties);
  element.append(...children);
  return element;
};
const data = JSON.parse($('#page-data').textContent);
const cells = new Map(data.cells.map(cell => [cell.id, cell]));
const charts = $$('svg.chart');
const numbers = text => text ? text.split(' ').map(Number) : null;
const plotOf = svg => {
  const [x, y, w, h] = numbers(svg.dataset.plot);
  return { x, y, w, h, xs: numbers(svg.dataset.x), ys: numbers(svg.dataset.y) };
};
const views = new WeakMap();
const viewOf = svg => views.get(svg) || { k: 1, x: 0, y: 0 };

// A place in the window, in the units of a chart's drawing.
const unitsAt = (svg, clientX, clientY) => {
  const at = new DOMPoint(clientX, clientY).matrixTransform(svg.getScreenCTM().inverse());
  const view = viewOf(svg);
  return { x: (at.x - view.x) / view.k, y: (at.y - view.y) / view.k, rawX: at.x, rawY: at.y };
};
// The value on the x axis there; null on an axis of names.
const valueAt = (svg, x) => {
  const plot = plotOf(svg);
  return plot.xs && plot.xs[0] + (x - plot.x) / plot.w * (plot.xs[1] - plot.xs[0]);
};

const status = make('p', { className: 'unseen', id: 'said' });
status.setAttribute('role', 'status');
const say = text => { status.textContent = text; };
document.body.append(status);
document.documentElement.classList.add('enhanced');
for (const hidden of $$('[data-script]')) hidden.hidden = false;
