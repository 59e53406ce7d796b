'use strict';
// Plays a traversal. Addresses are made of ids and numbers; strings are inserted as text, never as HTML.
(() => {
  const root = document.getElementById('player');
  const slider = document.getElementById('frame');
  if (!slider) return;
  const get = (id) => document.getElementById(id);
  const [left, second, overLeft, overSecond] = ['left', 'second', 'over-left', 'over-second'].map(get);
  const [where, status, beside, play, here, secondText] = ['where', 'status', 'beside', 'play', 'here', 'second-text'].map(get);
  const [keypoints, matches] = ['keypoints', 'matches'].map(get);
  const traversal = '/traversal/' + root.dataset.traversal;
  const frames = Number(root.dataset.frames);
  const [, , wide, high] = overLeft.getAttribute('viewBox').split(' ').map(Number);
  let now = Number(slider.value), track = null, answers = null, busy = false, asked = 0, timer = null;

  const ask = async (path) => {
    const answer = await fetch(path);
    if (!answer.ok) throw new Error(await answer.text());
    return answer.json();
  };
  const say = (text) => { status.textContent = text; };

  // What a frame is compared with: its image, words, and where the matches to it are.
  const partner = (frame) => {
    if (beside.value === 'right') return { picture: `${traversal}/frame/${frame}/right.jpg`, text: 'Right image' };
    if (beside.value === 'before') {
      const key = track && track.before[frame];
      if (!Number.isInteger(key)) return { text: 'No keyframe before this frame' };
      return { picture: `${traversal}/frame/${key}/left.jpg`, text: `Keyframe before: frame ${key}`, matches: `${traversal}/frame/${frame}/before` };
    }
    const answer = answers && answers[frame];
    if (!answer) return { text: answers ? 'The run did not use this frame' : 'Loading the answers …' };
    if (!Number.isInteger(answer.node)) return { text: answer.text };
    const node = `${answer.experience}/${answer.node}`;
    return { picture: `/experience/${answer.experience}/node/${answer.node}`, text: `Node ${answer.node}: ${answer.text}`, matches: `${traversal}/frame/${frame}/matches/${node}` };
  };

  const load = async (image, path, alt) => {
    if (!path) { image.style.visibility = 'hidden'; image.alt = ''; return; }
    const next = new Image();
    next.src = path;
    try { await next.decode(); } catch {
      const answer = await fetch(path);
      throw new Error(answer.ok ? 'an image cannot be decoded' : await answer.text());
    }
    image.src = path;
    image.alt = alt;
    image.style.visibility = '';
  };

  const words = (frame) => {
    if (!track) return `${frame} of ${frames}`;
    const metres = track.travelled_m[frame];
    return `${frame} of ${frames}, ${track.seconds[frame].toFixed(1)} s, ${metres === undefined ? '' : metres.toFixed(1) + ' m'}`;
  };

  const clear = () => { overLeft.replaceChildren(); overSecond.replaceChildren(); };
  const shape = (name, numbers, kind) => {
    const element = document.createElementNS('http://www.w3.org/2000/svg', name);
    for (const [key, value] of Object.entries(numbers)) element.setAttribute(key, value);
    if (kind) element.setAttribute('class', kind);
    return element;
  };

  const overlays = async (frame) => {
    const mine = ++asked;
    const shown = partner(frame);
    const wanted = [];
    if (keypoints.checked) wanted.push(ask(`${traversal}/frame/${frame}/keypoints`).then((found) => {
      if (mine !== asked) return '';
      const circle = ([x, y, r]) => shape('circle', { cx: x * wide, cy: y * high, r: Math.max(r * wide, 1) });
      // The strongest come first; all of them would hide the image.
      const drawn = found.keypoints.slice(0, 300);
      overLeft.append(...drawn.map(circle));
      const all = found.keypoints.length;
      return `${all} keypoints${all > drawn.length ? `, the ${drawn.length} strongest drawn` : ''}`;
    }));
    if (matches.checked && shown.matches) wanted.push(ask(shown.matches).then((found) => {
      if (mine !== asked) return '';
      for (const [[x, y], [u, v]] of found.lines) {
        overLeft.append(shape('path', { d: `M${u * wide} ${v * high}L${x * wide} ${y * high}` }), shape('circle', { cx: x * wide, cy: y * high, r: 2.4 }, 'match'));
        overSecond.append(shape('circle', { cx: u * wide, cy: v * high, r: 2.4 }, 'match'));
      }
      return `${found.lines.length} inliers of ${found.matches} matches`;
    }));
    if (matches.checked && !shown.matches) wanted.push(Promise.resolve(shown.picture && beside.value === 'right' ? 'Matches are drawn to a keyframe or node: choose one to compare with' : ''));
    try {
      const texts = (await Promise.all(wanted)).filter(Boolean);
      if (mine === asked) { root.dataset.drawn = frame; if (texts.length) say(texts.join(', ')); }
    } catch (error) { if (mine === asked) say(error.message); }
  };

  // Images follow the slider as fast as they arrive; frames that were skipped meanwhile are not requested.
  const follow = async () => {
    if (busy) return;
    busy = true;
    let shown = -1;
    while (shown !== now) {
      shown = now;
      const other = partner(shown);
      try {
        await Promise.all([load(left, `${traversal}/frame/${shown}/left.jpg`, `Left image of frame ${shown}`), load(second, other.picture, other.text)]);
        if (!keypoints.checked && !matches.checked) say('');
      } catch (error) { say(error.message); }
      secondText.textContent = other.text;
      root.dataset.shown = shown;
    }
    busy = false;
    if (keypoints.checked || matches.checked) await overlays(now);
    if (now + 1 < frames) new Image().src = `${traversal}/frame/${now + 1}/left.jpg`;
  };

  const show = (frame) => {
    now = Math.min(Math.max(Math.round(frame), 0), frames - 1);
    asked += 1;
    clear();
    slider.value = now;
    where.textContent = words(now);
    slider.setAttribute('aria-valuetext', 'frame ' + words(now));
    const at = track && track.at[now];
    here.setAttribute('cx', at ? at[0] : -20);
    here.setAttribute('cy', at ? at[1] : -20);
    if (track && track.valid[now] === false) say('odometry failed on the step that leads here');
    follow();
  };

  const stop = () => {
    cancelAnimationFrame(timer);
    timer = null;
    play.textContent = 'Play';
    play.setAttribute('aria-pressed', 'false');
  };
  const start = () => {
    if (!track) return;
    if (now === frames - 1) show(0);
    const began = performance.now() / 1000 - track.seconds[now];
    const step = () => {
      const second = performance.now() / 1000 - began;
      let frame = now;
      while (frame + 1 < frames && track.seconds[frame + 1] <= second) frame += 1;
      if (frame !== now) show(frame);
      if (now === frames - 1) stop(); else timer = requestAnimationFrame(step);
    };
    play.textContent = 'Pause';
    play.setAttribute('aria-pressed', 'true');
    timer = requestAnimationFrame(step);
  };
  const toggle = () => (timer === null ? start() : stop());

  slider.addEventListener('input', () => { stop(); show(Number(slider.value)); });
  get('back').addEventListener('click', () => { stop(); show(now - 1); });
  get('on').addEventListener('click', () => { stop(); show(now + 1); });
  play.addEventListener('click', toggle);
  for (const box of [keypoints, matches]) box.addEventListener('change', () => { say(''); show(now); });
  const choose = async () => {
    answers = null;
    const cell = beside.value;
    if (cell !== 'right' && cell !== 'before') {
      try {
        const found = await ask(`${traversal}/answers/${cell}`);
        if (beside.value === cell) answers = found.answers;
      } catch (error) { say(error.message); }
    }
    show(now);
  };
  beside.addEventListener('change', choose);
  document.addEventListener('keydown', (event) => {
    if (event.altKey || event.ctrlKey || event.metaKey) return;
    const own = event.target.closest('input, select, textarea, button, a, summary, [tabindex]');
    if (event.key === ' ' && (!own || own === slider)) { event.preventDefault(); toggle(); }
    const leap = { ArrowLeft: -1, ArrowRight: 1, PageUp: 10, PageDown: -10 }[event.key];
    if (leap && (own === slider || (!own && event.key.startsWith('Arrow')))) { event.preventDefault(); stop(); show(now + leap); }
  });
  const views = root.querySelector('.views');
  let drag = null;
  views.addEventListener('pointerdown', (event) => { drag = { x: event.clientX, frame: now }; });
  window.addEventListener('pointermove', (event) => {
    if (!drag || Math.abs(event.clientX - drag.x) < 4) return;
    stop();
    show(drag.frame + (event.clientX - drag.x) / views.clientWidth * frames);
  });
  for (const end of ['pointerup', 'pointercancel']) window.addEventListener(end, () => { drag = null; });
  views.addEventListener('dragstart', (event) => event.preventDefault());

  (async () => {
    try { track = await ask(`${traversal}/track`); } catch (error) { say(error.message); return; }
    const cell = location.hash.slice(1);
    if ([...beside.options].some((option) => option.value === cell)) beside.value = cell;
    await choose();
    root.dataset.ready = 'yes';
  })();
})();
