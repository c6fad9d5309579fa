// SPDX-License-Identifier: Apache-2.0
// The sliders of the live view's page: exposure, lights, materials. Each sends its key by wish(), see page.js.
'use strict';
let home_sliders = '';
const reference = new Map();   // of logarithmic sliders: their middle, fixed when first seen

function slider(into, id, name, {value, from, to, log, unit: suffix = '', step, apply}) {
  const row = document.createElement('div'), label = document.createElement('label');
  const input = document.createElement('input'), output = document.createElement('output');
  const show = v => { output.textContent = short(v) + suffix; input.setAttribute('aria-valuetext', output.textContent); };
  const [a, b] = log ? [Math.log(from), Math.log(to)] : [from, to];
  row.className = 'slider';
  label.htmlFor = input.id = id;
  label.textContent = name;
  Object.assign(input, {type: 'range', min: a, max: b, step: step || (b - a) / 400});
  input.value = log ? Math.log(Math.max(value, from)) : value;
  show(value);
  input.addEventListener('input', () => {
    const v = log ? Math.exp(Number(input.value)) : Number(input.value);
    show(v);
    apply(v);
  });
  row.append(label, input, output);
  into.append(row);
}
function heading(into, text) {
  const h = document.createElement('h2');
  h.textContent = text;
  into.append(h);
}
/// A positive quantity of three colours by its largest; their ratio stays.
function amount(into, id, name, key, colours, suffix, ceiling) {
  const largest = Math.max(...colours);
  if (!reference.has(key)) reference.set(key, largest > 0 ? largest : ceiling);
  const middle = reference.get(key), ratio = largest > 0 ? colours.map(c => c / largest) : [1, 1, 1];
  slider(into, id, name, {value: largest, from: middle / 30, to: middle * 30, log: true, unit: suffix,
    apply: v => wish(key, list(ratio.map(c => c * v)))});
}

function build_lights() {
  const into = by('lights'), {lower, upper} = state.grid, u = state.scene.unit;
  into.replaceChildren();
  const middle = add(lower, upper).map(x => x / 2), frame = axes([0, 1, 0]);
  if (state.lights.length === 0) into.textContent = 'none: materials emit';
  state.lights.forEach((light, i) => {
    const key = 'light.' + i, sun = light.type === 'directional', centre = light.target || middle;
    heading(into, light.name + ', ' + light.type);
    const at = spherical(sun ? light.direction.map(x => -x) : add(light.position, centre, -1), frame);
    const move = () => {
      const offset = cartesian(at, frame);
      if (sun) return wish(key + '.direction', list(offset.map(x => -x)));
      wish(key + '.position', list(add(centre, offset)));
      if (light.type === 'spot' && !light.target) wish(key + '.direction', list(offset.map(x => -x)));
    };
    const degrees = 180 / Math.PI;
    slider(into, key + '.azimuth', 'azimuth', {value: at.azimuth * degrees, from: -180, to: 180, step: 1, unit: '°',
      apply: v => { at.azimuth = v / degrees; move(); }});
    slider(into, key + '.elevation', 'elevation', {value: at.elevation * degrees, from: -89, to: 89, step: 1, unit: '°',
      apply: v => { at.elevation = v / degrees; move(); }});
    if (!sun) {
      if (!reference.has(key)) reference.set(key, at.r || 1);
      slider(into, key + '.distance', 'distance', {value: at.r, from: reference.get(key) / 10, to: reference.get(key) * 5,
        log: true, unit: ' ' + u, apply: v => { at.r = v; move(); }});
    }
    const power = sun ? 'irradiance' : 'power';
    amount(into, key + '.' + power, power, key + '.' + power, light[power], sun ? ' W/' + u + '²' : ' W', 1);
    if (light.type === 'spot')
      slider(into, key + '.angle', 'cone', {value: light.angle, from: 1, to: 170, step: 1, unit: '°',
        apply: v => wish(key + '.angle', v.toFixed(1))});
  });
}
function build_materials() {
  const into = by('materials'), u = state.scene.unit, size = length(add(state.grid.upper, state.grid.lower, -1));
  into.replaceChildren();
  for (const material of state.materials) {
    heading(into, material.name + (material.opaque ? ', opaque' : ''));
    const key = 'material.' + (/^[\w-]+$/.test(material.name) ? material.name : JSON.stringify(material.name));
    for (const [name, low, high] of [['sigma_s'], ['sigma_a'], ['eta', 1, 3], ['g', -0.95, 0.95]]) {
      const it = material[name];
      if (!it) continue;
      const id = key + '.' + name;
      if (it.scale) {
        slider(into, id, name + ' ×', {value: Math.max(...it.scale), from: name === 'eta' ? 0.5 : 0.05, to: name === 'eta' ? 2 : 20,
          log: true, apply: v => wish(id + '.scale', low === undefined ? list(it.scale.map(c => c / Math.max(...it.scale) * v)) : v.toPrecision(5))});
      } else if (it.value && low === undefined) {
        amount(into, id, name, id, it.value, '/' + u, 1 / size);
      } else if (it.value) {
        slider(into, id, name, {value: it.value[0], from: low, to: high, step: 0.01, apply: v => wish(id, v.toFixed(3))});
      } else {
        const row = document.createElement('p');
        row.className = 'quiet';
        row.textContent = name + ': ' + it.field;
        into.append(row);
      }
    }
  }
}
function build_film() {
  const into = by('film'), auto = state.exposure === 'auto';
  into.replaceChildren();
  const row = document.createElement('label'), box = document.createElement('input');
  row.className = 'choice';
  Object.assign(box, {type: 'checkbox', checked: auto, id: 'auto'});
  row.append(box, 'automatic exposure');
  into.append(row);
  const shown = state.picture ? state.picture.exposure : 0, value = auto ? shown : state.exposure;
  if (!reference.has('film') && state.picture) reference.set('film', Math.round(value));
  const middle = reference.get('film') || 0;
  slider(into, 'exposure', 'exposure', {value, from: middle - 8, to: middle + 8, step: 0.05, unit: ' stops',
    apply: v => { box.checked = false; wish('film.exposure', v.toFixed(2)); }});
  box.addEventListener('change', () => wish('film.exposure', box.checked ? '"auto"' : state.picture.exposure.toFixed(2)));
  slider(into, 'fov', 'view angle', {value: state.camera.fov, from: 5, to: 100, step: 0.5, unit: '°',
    apply: v => { if (camera) camera.fov = v; wish('camera.fov', v.toFixed(2)); }});
}
/// Sliders are made anew only if what they show has another origin than this page's own moves.
function build_sliders() {
  const names = JSON.stringify([state.scene.name, state.lights.map(l => l.type), state.materials.map(m => m.name), Boolean(state.picture)]);
  if (names === home_sliders) return;
  home_sliders = names;
  build_film();
  build_lights();
  build_materials();
}
