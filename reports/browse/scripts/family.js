'use strict';
// Steps through the nodes of an experience and of those generated from it. Strings are inserted as text, never as HTML.
(() => {
  const root = document.getElementById('family');
  const place = document.getElementById('place');
  if (!place) return;
  const get = (id) => document.getElementById(id);
  const [image, caption, where, z, which, strip, generator] = ['image', 'caption', 'where', 'z', 'which', 'strip', 'generator'].map(get);
  const nodes = Number(root.dataset.nodes);
  let found = null, members = [], chosen = 0;

  const picture = (member, node) => `/experience/${member.id}/node/${node}`;
  const named = (member) => (member.z === 0 && member === found.family.parent ? `z = 0, as recorded at ${member.slot}` : `z = ${member.z}, mimics ${member.slot}`);

  // What was recorded nearest to a node at the hour that a child mimics.
  const real = (member, node) => {
    const there = member !== found.family.parent && found.recorded[member.slot];
    const nearest = there && there.nearest[node];
    return nearest ? { path: `/experience/${there.experience}/node/${nearest[0]}`, text: `recorded at ${member.slot}, ${nearest[1].toFixed(1)} m away` } : null;
  };

  const tile = (path, text, press) => {
    const item = document.createElement('li');
    const holder = document.createElement(press ? 'button' : 'div');
    const view = document.createElement('div');
    const shown = document.createElement('img');
    const line = document.createElement('span');
    item.className = 'card';
    view.className = 'view';
    line.className = 'line';
    shown.width = image.width;
    shown.height = image.height;
    shown.src = path;
    shown.alt = '';
    line.textContent = text;
    view.append(shown);
    holder.append(view, line);
    if (press) { holder.type = 'button'; holder.addEventListener('click', press); }
    item.append(holder);
    return item;
  };

  const show = () => {
    const node = Number(place.value);
    where.textContent = `${node} of ${nodes}`;
    place.setAttribute('aria-valuetext', `node ${node} of ${nodes}`);
    const member = members[chosen];
    image.src = picture(member, node);
    image.alt = `Node ${node}, ${named(member)}`;
    caption.textContent = named(member);
    root.dataset.shown = `${node} ${member.id}`;
    if (!z) return;
    z.value = chosen;
    which.textContent = String(member.z);
    z.setAttribute('aria-valuetext', named(member));
    const tiles = members.map((one, i) => tile(picture(one, node), named(one), () => { chosen = i; show(); strip.querySelectorAll('button')[i].focus(); }));
    tiles[chosen].classList.add('chosen');
    const slots = new Set();
    for (const one of members) {
      const recorded = real(one, node);
      if (recorded && !slots.has(one.slot)) tiles.push(tile(recorded.path, recorded.text));
      slots.add(one.slot);
    }
    strip.replaceChildren(...tiles);
  };

  const choose = () => {
    const generated = generator ? found.family.generators[Number(generator.value)].members : [];
    members = [found.family.parent, ...generated];
    if (z) z.max = members.length - 1;
    chosen = Math.max(0, members.findIndex((member) => member.id === root.dataset.experience));
    show();
  };

  place.addEventListener('input', show);
  if (z) z.addEventListener('input', () => { chosen = Number(z.value); show(); });
  if (generator) generator.addEventListener('change', choose);
  (async () => {
    const answer = await fetch(`/experience/${root.dataset.experience}/family`);
    if (!answer.ok) { caption.textContent = await answer.text(); return; }
    found = await answer.json();
    choose();
    root.dataset.ready = 'yes';
  })();
})();
