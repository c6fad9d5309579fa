// SPDX-License-Identifier: Apache-2.0
// The page of turbid view: shows the newest picture, turns gestures and sliders into lines such as `camera.fov=30`, and
// sends the newest ones as soon as the ones before were taken.
'use strict';
const by = id => document.getElementById(id);
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const add = (a, b, s = 1) => a.map((x, i) => x + s * b[i]);
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const length = a => Math.sqrt(dot(a, a));
const unit = a => a.map(x => x / (length(a) || 1));
const list = a => '[' + a.map(x => Number(x.toPrecision(7))).join(', ') + ']';
const short = x => x === 0 ? '0' : Math.abs(x) >= 1e-3 && Math.abs(x) < 1e5 ? String(Number(x.toPrecision(3))) : x.toExponential(2);
const seconds = s => s < 1 ? Math.round(1000 * s) + ' ms' : s.toFixed(2) + ' s';

let state = null, camera = null, home = null, busy = false;
const wishes = new Map();   // key -> value, the newest of each

function say(text) { by('message').textContent = text; by('message').hidden = !text; }

async function send() {
  if (busy || wishes.size === 0) return;
  busy = true;
  const body = [...wishes].map(([key, value]) => key + '=' + value).join('\n');
  wishes.clear();
  try {
    const answer = await fetch('change', {method: 'POST', body});
    const text = (await answer.text()).trim();
    say(answer.ok ? '' : text);
    if (!answer.ok) forget();
  } catch (error) { say('the server does not answer'); }
  busy = false;
  send();
}
function wish(key, value) { wishes.set(key, value); send(); }
/// What the page holds of its own is taken from the next state again.
function forget() { camera = null; home_sliders = ''; }

// Camera ---------------------------------------------------------------------------------------------------------
function send_camera() {
  wishes.set('camera.position', list(camera.position));
  wishes.set('camera.target', list(camera.target));
  send();
}
/// An orthonormal frame whose second axis is up.
function axes(up) {
  const y = unit(up), x = unit(cross(Math.abs(y[0]) < 0.9 ? [1, 0, 0] : [0, 0, 1], y));
  return [x, y, cross(x, y)];
}
function spherical(v, frame) {
  const r = length(v), [x, y, z] = frame.map(a => dot(v, a) / (r || 1));
  return {r, azimuth: Math.atan2(x, z), elevation: Math.asin(Math.max(-1, Math.min(1, y)))};
}
function cartesian({r, azimuth, elevation}, frame) {
  const c = Math.cos(elevation), parts = [Math.sin(azimuth) * c, Math.sin(elevation), Math.cos(azimuth) * c];
  return frame.reduce((sum, a, i) => add(sum, a, r * parts[i]), [0, 0, 0]);
}
function orbit(dx, dy) {
  const frame = axes(camera.up), at = spherical(add(camera.position, camera.target, -1), frame);
  at.azimuth -= dx * 0.008;
  at.elevation = Math.max(-1.53, Math.min(1.53, at.elevation + dy * 0.008));
  camera.position = add(camera.target, cartesian(at, frame));
  send_camera();
}
function zoom(factor) {
  const offset = add(camera.position, camera.target, -1);
  const r = Math.max(length(offset) * factor, 1e-3 * length(add(state.grid.upper, state.grid.lower, -1)));
  camera.position = add(camera.target, unit(offset), r);
  send_camera();
}
function pan(dx, dy) {
  const back = add(camera.position, camera.target, -1), right = unit(cross(camera.up, back)), up = unit(cross(back, right));
  const scale = 2 * length(back) * Math.tan(camera.fov * Math.PI / 360) / by('frame').clientHeight;
  const shift = add(right.map(x => -dx * scale * x), up, dy * scale);
  camera.position = add(camera.position, shift);
  camera.target = add(camera.target, shift);
  send_camera();
}

const touches = new Map();
const frame = by('frame');
const spread = () => { const [a, b] = [...touches.values()]; return Math.hypot(a[0] - b[0], a[1] - b[1]); };
frame.addEventListener('pointerdown', event => {
  frame.setPointerCapture(event.pointerId);
  touches.set(event.pointerId, [event.clientX, event.clientY]);
});
frame.addEventListener('pointermove', event => {
  const last = touches.get(event.pointerId);
  if (!last || !camera) return;
  const dx = event.clientX - last[0], dy = event.clientY - last[1], wide = touches.size === 2 ? spread() : 0;
  touches.set(event.pointerId, [event.clientX, event.clientY]);
  if (touches.size === 2) {
    pan(dx / 2, dy / 2);
    if (spread() > 0) zoom(wide / spread());
  } else if (event.shiftKey || event.buttons & 6) {
    pan(dx, dy);
  } else {
    orbit(dx, dy);
  }
});
for (const end of ['pointerup', 'pointercancel']) frame.addEventListener(end, event => touches.delete(event.pointerId));
frame.addEventListener('contextmenu', event => event.preventDefault());
frame.addEventListener('wheel', event => {
  event.preventDefault();
  if (camera) zoom(Math.exp(Math.max(-100, Math.min(100, event.deltaY)) * 0.0015));
}, {passive: false});
frame.addEventListener('keydown', event => {
  if (!camera) return;
  const step = 12, move = event.shiftKey ? pan : orbit;
  const keys = {ArrowLeft: () => move(-step, 0), ArrowRight: () => move(step, 0), ArrowUp: () => move(0, -step),
    ArrowDown: () => move(0, step), '+': () => zoom(0.9), '=': () => zoom(0.9), '-': () => zoom(1 / 0.9),
    '0': () => { camera = structuredClone(home); send_camera(); }};
  if (!keys[event.key]) return;
  event.preventDefault();
  keys[event.key]();
});

// Figures --------------------------------------------------------------------------------------------------------
function rows(into, data) {
  into.replaceChildren(...data.map(cells => {
    const row = document.createElement('tr');
    row.append(...cells.map(cell => {
      const td = document.createElement('td');
      if (cell && cell.rail !== undefined) {
        td.className = 'rail';
        const bar = document.createElement('i');
        bar.style.width = 100 * cell.rail + '%';
        td.append(bar);
      } else {
        td.textContent = cell;
      }
      return td;
    }));
    return row;
  }));
}
function figures() {
  const s = state.solver, p = state.picture, pairs = [];
  const pair = (name, text, kind) => pairs.push([name, text, kind]);
  if (p) pair('picture', p.width + ' × ' + p.height + ', ' + p.samples + (p.samples > 1 ? ' samples' : ' sample'));
  if (p && state.first_seconds > 0) pair('first picture after', seconds(state.first_seconds));
  if (p && p.refined) pair('refined after', seconds(p.seconds));
  if (s) {
    pair('solver', s.name + ', ' + s.iterations + ' iterations');
    pair('error estimate', s.error_estimate.toExponential(1));
    pair('energy imbalance', s.energy.imbalance.toExponential(1), s.energy.balanced ? 'good' : 'bad');
    pair('active voxels', s.active_voxels.toLocaleString('en'));
  }
  pair('grid', state.grid.voxels.join(' × '));
  pair('device', state.device);
  by('figures').replaceChildren(...pairs.flatMap(([name, text, kind]) => {
    const dt = document.createElement('dt'), dd = document.createElement('dd');
    dt.textContent = name;
    dd.textContent = text;
    if (kind) dd.className = kind;
    return [dt, dd];
  }));
  const longest = Math.max(1e-9, ...state.times.map(t => t.seconds));
  rows(by('times'), state.times.map(t => [t.name, {rail: t.seconds / longest}, seconds(t.seconds)]));
  if (s) rows(by('energy'), ['emitted', 'missed', 'reflected', 'absorbed', 'escaped', 'in_flight']
    .map(name => [name.replace('_', ' '), ...s.energy[name].map(short)]));
}

// State and picture ------------------------------------------------------------------------------------------------
let shown = 0, loading = false;
async function load_picture() {
  if (loading || !state.picture || state.picture.number === shown) return;
  loading = true;
  try {
    const answer = await fetch('picture.png');
    const blob = await answer.blob(), old = by('picture').src;
    const image = by('picture');
    image.src = URL.createObjectURL(blob);
    await image.decode().catch(() => {});
    if (old.startsWith('blob:')) URL.revokeObjectURL(old);
    shown = Number(answer.headers.get('X-Picture'));
    by('waiting').hidden = true;
  } catch (error) { /* the next state tries again */ }
  loading = false;
  if (state.picture.number > shown) load_picture();
}
function take(next) {
  state = next;
  const touched = busy || wishes.size > 0 || touches.size > 0;
  if (!camera || !touched) camera = structuredClone(state.camera);
  if (!home) home = structuredClone(state.camera);
  if (state.message) { say(state.message); home_sliders = ''; }
  build_sliders();
  figures();
  by('name').textContent = state.scene.name;
  document.title = state.scene.name + ' · turbid';
  by('get_scene').download = state.scene.name + '.toml';
  by('get_picture').download = state.scene.name + '.png';
  const image = by('picture');
  image.style.aspectRatio = state.camera.width + ' / ' + state.camera.height;
  image.style.width = state.camera.width + 'px';
  image.alt = 'The scene ' + state.scene.name;
  by('waiting').textContent = state.stage ? state.stage : 'Preparing the scene';
  by('status').textContent = state.stage || 'refined';
  by('bar').style.width = state.stage ? 100 * state.fraction + '%' : '0';
  load_picture();
}
async function follow() {
  let after = 0;
  while (true) {
    try {
      const answer = await fetch('state?after=' + after);
      const next = await answer.json();
      after = next.number;
      take(next);
    } catch (error) {
      by('status').textContent = 'not connected';
      after = 0;
      await new Promise(done => setTimeout(done, 1000));
    }
  }
}

// Saving -------------------------------------------------------------------------------------------------------------
for (const what of ['scene', 'picture']) {
  const button = by('save_' + what);
  button.addEventListener('click', async () => {
    button.disabled = true;
    by('saved').textContent = 'saving the ' + what;
    try {
      const answer = await fetch('save/' + what, {method: 'POST', body: ''});
      by('saved').textContent = answer.ok ? 'saved ' + (await answer.json()).files.join(' and ') : (await answer.text()).trim();
    } catch (error) { by('saved').textContent = 'the server does not answer'; }
    button.disabled = false;
  });
}
follow();
