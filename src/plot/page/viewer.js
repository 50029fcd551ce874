"use strict";
/* Shows the data of the page: see mod.rs for what they are. Lengths are mm until they are shown. */
const data = JSON.parse(document.getElementById("data").textContent);
const lines = JSON.parse(document.getElementById("text").textContent).split(/\r?\n/);
const element = id => document.getElementById(id);
const view = element("view"), slider = element("slider"), tip = element("tip");

function bytes(text) {
  const raw = atob(text), out = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; i++) out[i] = raw.charCodeAt(i);
  return out;
}
const floats = text => new Float32Array(bytes(text).buffer);
const integers = text => new Uint32Array(bytes(text).buffer);

const points = floats(data.points), time = floats(data.time), feed = floats(data.feed);
const line = integers(data.line), from = integers(data.from), to = integers(data.to);
const tool = integers(data.tool), operation = integers(data.operation), what = bytes(data.what);
const count = line.length;
const COLOURS = ["#c92a2a", "#5b87bd", "#8250c4", "#d9820a", "#1f7a4d"];

/* ---- numbers ---- */
const minus = text => text.replace("-", "\u2212");
const length = (mm, digits = 4) => minus((mm / data.unit[1]).toFixed(digits));
const little = mm => minus((mm / data.small[1]).toFixed(2)) + " " + data.small[0];
const place = p => "X " + length(p[0]) + "  Y " + length(p[1]) + "  Z " + length(p[2]);
function clock(seconds) {
  const whole = Math.floor(seconds), two = n => String(n).padStart(2, "0");
  const hours = Math.floor(whole / 3600), rest = two(Math.floor(whole / 60) % 60) + ":" + two(whole % 60);
  return hours > 0 ? hours + ":" + rest : rest;
}
function textElement(name, text) {
  const made = document.createElement(name);
  made.textContent = text;
  return made;
}

/* ---- scene ---- */
const scene = new THREE.Scene();
const camera = new THREE.OrthographicCamera(-1, 1, 1, -1, -1e4, 1e5);
camera.up.set(0, 0, 1);
let renderer = null, controls = null, asked = false;

function draw() {
  if (asked || !renderer) return;
  asked = true;
  requestAnimationFrame(() => {
    asked = false;
    renderer.render(scene, camera);
    placeLabels();
  });
}

const box = new THREE.Box3();
for (let i = 0; i < count; i++) {
  if (what[i] === 0) continue;
  for (let k = from[i]; k <= to[i]; k++) box.expandByPoint(new THREE.Vector3().fromArray(points, 3 * k));
}
for (const blank of data.stocks) {
  box.expandByPoint(new THREE.Vector3(...blank.low));
  box.expandByPoint(new THREE.Vector3(...blank.high));
}

/* ---- surfaces ---- */
function ramp(value, range) {
  if (Number.isNaN(value)) return data.ramp.uncut;
  const share = value < 0 ? -value / range[0] : value / range[1];
  if (Math.abs(share) > 1.001) return data.ramp.beyond[share > 0 ? 1 : 0];
  const stops = share < 0 ? data.ramp.into : data.ramp.left;
  const at = Math.min(1, Math.abs(share)) * (stops.length - 1), index = Math.min(Math.floor(at), stops.length - 2);
  return stops[index].map((c, k) => c + (stops[index + 1][k] - c) * (at - index));
}

const surfaceMaterials = { measured: new THREE.MeshLambertMaterial({ vertexColors: true, side: THREE.DoubleSide, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 2 }),
  plain: new THREE.MeshLambertMaterial({ color: "#c9d6e3", side: THREE.DoubleSide, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 2 }) };

function patchMesh(patch, range) {
  const geometry = new THREE.BufferGeometry();
  const position = floats(patch.points), index = [];
  for (let i = 0; i + 1 < patch.rows; i++) {
    for (let j = 0; j + 1 < patch.columns; j++) {
      const a = i * patch.columns + j, b = a + patch.columns;
      index.push(a, b, a + 1, b, b + 1, a + 1);
    }
  }
  geometry.setAttribute("position", new THREE.BufferAttribute(position, 3));
  geometry.setIndex(new THREE.BufferAttribute(new Uint32Array(index), 1));
  geometry.computeVertexNormals();
  box.union(new THREE.Box3().setFromBufferAttribute(geometry.getAttribute("position")));
  const mesh = new THREE.Mesh(geometry, surfaceMaterials.plain);
  if (patch.left) {
    mesh.userData = { left: floats(patch.left), line: integers(patch.line) };
    const colours = new Uint8Array(mesh.userData.left.length * 3), colour = new THREE.Color();
    mesh.userData.left.forEach((value, k) => {
      const [r, g, b] = ramp(value, range);
      colour.setRGB(r / 255, g / 255, b / 255, "srgb");
      colours.set([colour.r * 255, colour.g * 255, colour.b * 255].map(Math.round), 3 * k);
    });
    geometry.setAttribute("color", new THREE.BufferAttribute(colours, 3, true));
    mesh.material = surfaceMaterials.measured;
  }
  return mesh;
}

const surfaces = data.surfaces.map(surface => {
  const group = new THREE.Group();
  for (const patch of surface.patches) group.add(patchMesh(patch, surface.range));
  scene.add(group);
  return group;
});

/* ---- blank and edges of the part ---- */
const stock = new THREE.Group(), part = new THREE.Group();
for (const blank of data.stocks) {
  const size = blank.high.map((h, k) => Math.max(h - blank.low[k], 1e-3));
  const solid = blank.round ? new THREE.CylinderGeometry(size[0] / 2, size[0] / 2, size[2], 96).rotateX(Math.PI / 2) : new THREE.BoxGeometry(...size);
  const glass = new THREE.Mesh(solid, new THREE.MeshLambertMaterial({ color: "#c9a46a", transparent: true, opacity: 0.16, depthWrite: false, side: THREE.DoubleSide }));
  const rim = new THREE.LineSegments(new THREE.EdgesGeometry(solid, 30), new THREE.LineBasicMaterial({ color: "#9a7b4f" }));
  for (const made of [glass, rim]) {
    made.position.set(...blank.high.map((h, k) => (h + blank.low[k]) / 2));
    stock.add(made);
  }
}
const partMaterial = new THREE.MeshLambertMaterial({ color: "#b8cce4", side: THREE.DoubleSide, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 2 });
for (const edge of data.edges) {
  const plane = floats(edge), n = plane.length / 2, position = new Float32Array(6 * n), index = [];
  for (let i = 0; i < n; i++) {
    position.set([plane[2 * i], plane[2 * i + 1], data.walls[0], plane[2 * i], plane[2 * i + 1], data.walls[1]], 6 * i);
    if (i + 1 < n) index.push(2 * i, 2 * i + 2, 2 * i + 1, 2 * i + 2, 2 * i + 3, 2 * i + 1);
  }
  const wall = new THREE.BufferGeometry();
  wall.setAttribute("position", new THREE.BufferAttribute(position, 3));
  wall.setIndex(index);
  wall.computeVertexNormals();
  part.add(new THREE.Mesh(wall, partMaterial));
  for (const k of [0, 1]) {
    const rim = new THREE.BufferGeometry();
    rim.setAttribute("position", new THREE.BufferAttribute(position.filter((_, i) => (Math.floor(i / 3) % 2) === k), 3));
    part.add(new THREE.Line(rim, new THREE.LineBasicMaterial({ color: "#0b4a8f" })));
  }
  const outline = Array.from({ length: n }, (_, i) => new THREE.Vector2(plane[2 * i], plane[2 * i + 1]));
  if (n > 3 && outline[0].distanceTo(outline[n - 1]) < 1e-3) {
    const lid = new THREE.BufferGeometry(), faces = THREE.ShapeUtils.triangulateShape(outline.slice(0, n - 1), []);
    lid.setAttribute("position", new THREE.BufferAttribute(new Float32Array(outline.flatMap(p => [p.x, p.y, data.walls[1]])), 3));
    lid.setIndex(faces.flat());
    lid.computeVertexNormals();
    part.add(new THREE.Mesh(lid, partMaterial));
  }
  box.union(new THREE.Box3().setFromBufferAttribute(wall.getAttribute("position")));
}
scene.add(stock, part);

/* ---- path: for each use what is done and what is to come, out of the same points ---- */
const shared = new THREE.BufferAttribute(points, 3);
const paths = data.uses.map((name, use) => {
  let pieces = 0;
  for (let i = 0; i < count; i++) if (what[i] === use) pieces += to[i] - from[i];
  const index = new Uint32Array(2 * pieces), owner = new Uint32Array(pieces), ends = new Uint32Array(count);
  let k = 0;
  for (let i = 0; i < count; i++) {
    if (what[i] === use) for (let p = from[i]; p < to[i]; p++, k++) { index[2 * k] = p; index[2 * k + 1] = p + 1; owner[k] = i; }
    ends[i] = 2 * k;
  }
  const made = [1, 0.3].map(opacity => {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", shared);
    geometry.setIndex(new THREE.BufferAttribute(index, 1));
    geometry.boundingSphere = null;
    const object = new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({ color: COLOURS[use], transparent: opacity < 1, opacity, depthWrite: opacity === 1 }));
    object.frustumCulled = false;
    scene.add(object);
    return object;
  });
  return { name, use, pieces, owner, index, ends, done: made[0], rest: made[1] };
});

/* ---- cutter ---- */
const cutters = new Map();
for (const cutter of data.tools) {
  const outline = cutter.outline.map(([r, z]) => new THREE.Vector2(r, z));
  const solid = new THREE.LatheGeometry(outline, 48).rotateX(Math.PI / 2);
  const mesh = new THREE.Mesh(solid, new THREE.MeshLambertMaterial({ color: "#f2b233", transparent: true, opacity: 0.5, side: THREE.DoubleSide }));
  mesh.visible = false;
  scene.add(mesh);
  cutters.set(cutter.number, mesh);
}
let cutterShown = true;

/* ---- axes at the corner of everything ---- */
box.isEmpty() && box.expandByPoint(new THREE.Vector3());
const size = box.getSize(new THREE.Vector3()), middle = box.getCenter(new THREE.Vector3());
const reach = Math.max(size.length(), 1e-3);
const axes = new THREE.Group(), labels = [];
[["#b3261e", "X", 0], ["#1f7a4d", "Y", 1], ["#0b4a8f", "Z", 2]].forEach(([colour, name, k]) => {
  const end = new THREE.Vector3().setComponent(k, 0.16 * reach), geometry = new THREE.BufferGeometry().setFromPoints([new THREE.Vector3(), end]);
  axes.add(new THREE.Line(geometry, new THREE.LineBasicMaterial({ color: colour })));
  const label = textElement("b", name);
  label.style.cssText = "position:absolute;transform:translate(-50%,-50%);pointer-events:none;color:" + colour;
  view.append(label);
  labels.push({ element: label, at: end.clone().multiplyScalar(1.12) });
});
scene.add(axes);

/* ---- light: from the eye, and from the sky ---- */
scene.add(new THREE.HemisphereLight("#ffffff", "#b9c4cf", 1.5));
const lamp = new THREE.DirectionalLight("#ffffff", 1.9);
scene.add(lamp, lamp.target);

/* ---- camera ---- */
const VIEWS = { iso: [-0.62, -1, 0.78], top: [0, -1e-4, 1], front: [0, -1, 0], right: [1, 0, 0] };
let towards = new THREE.Vector3(...VIEWS.iso).normalize();
function look(name) {
  if (name !== "fit") towards = new THREE.Vector3(...VIEWS[name]).normalize();
  else towards = camera.position.clone().sub(controls.target).normalize();
  controls.target.copy(middle);
  camera.position.copy(middle).addScaledVector(towards, 2 * reach);
  camera.near = -10 * reach;
  camera.far = 20 * reach;
  camera.zoom = 1;
  camera.lookAt(middle);
  camera.updateMatrixWorld();
  /* as large as the corners of the box allow */
  const inverse = camera.matrixWorldInverse.copy(camera.matrixWorld).invert();
  let [w, h] = [1e-6, 1e-6];
  for (let k = 0; k < 8; k++) {
    const corner = new THREE.Vector3(k & 1 ? box.max.x : box.min.x, k & 2 ? box.max.y : box.min.y, k & 4 ? box.max.z : box.min.z).applyMatrix4(inverse);
    w = Math.max(w, Math.abs(corner.x));
    h = Math.max(h, Math.abs(corner.y));
  }
  span = [1.12 * w, 1.16 * h];
  resize();
  controls.update();
}
let span = [1, 1];
function resize() {
  const [w, h] = [Math.max(view.clientWidth, 1), Math.max(view.clientHeight, 1)];
  const half = Math.max(span[1], span[0] * h / w);
  Object.assign(camera, { left: -half * w / h, right: half * w / h, top: half, bottom: -half });
  camera.updateProjectionMatrix();
  renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2));
  renderer.setSize(w, h);
  draw();
}

function onScreen(p) {
  const at = p.clone().project(camera);
  return [(at.x + 1) / 2 * view.clientWidth, (1 - at.y) / 2 * view.clientHeight];
}
function placeLabels() {
  lamp.position.copy(camera.position).addScaledVector(camera.up, 0.5 * reach);
  lamp.target.position.copy(controls.target);
  for (const label of labels) {
    const [x, y] = onScreen(label.at);
    label.element.style.left = x + "px";
    label.element.style.top = y + "px";
  }
}

/* ---- walking through the blocks ---- */
let now = -1;
const state = element("state"), nc = element("nc");
function rows(pairs) {
  state.replaceChildren(...pairs.flatMap(([name, value]) => [textElement("dt", name), textElement("dd", value)]));
}
function showLines(centre) {
  nc.replaceChildren(...[-3, -2, -1, 0, 1, 2, 3].map(by => {
    const number = centre + by, row = document.createElement("div"), known = number >= 1 && number <= lines.length;
    row.append(textElement("b", known ? number : ""), textElement("span", known ? lines[number - 1] : " "));
    if (by === 0) row.className = "now";
    else if (known) row.addEventListener("click", () => goToLine(number));
    return row;
  }));
}
/* After `index` moves, and a share of the one that follows. */
function go(index, share = 0) {
  index = Math.max(0, Math.min(count, index));
  const current = share > 0 ? index : index - 1, shown = Math.max(0, Math.min(current, count - 1));
  const at = position(index, share);
  for (const path of paths) {
    const end = index === 0 ? 0 : path.ends[index - 1];
    path.done.geometry.setDrawRange(0, end);
    path.rest.geometry.setDrawRange(end, Infinity);
  }
  for (const [number, mesh] of cutters) {
    mesh.visible = cutterShown && number === tool[shown];
    mesh.position.set(...at);
  }
  slider.value = index;
  const seconds = (index > 0 ? time[index - 1] : 0) + share * (time[shown] - (shown > 0 ? time[shown - 1] : 0));
  element("where").textContent = "move " + index + " of " + count + " · " + clock(seconds) + " of " + clock(time[count - 1]);
  if (shown !== now) {
    now = shown;
    showLines(line[shown]);
    history.replaceState(null, "", "#line=" + line[shown]);
  }
  const name = data.operations[operation[shown]];
  rows([["position", place(at)], ["move", data.uses[what[shown]] + (name ? " of " + name : "")],
    ["feed", what[shown] === 0 ? "rapid" : length(feed[shown], 1) + " " + data.unit[0] + "/min"], ["tool", "T" + tool[shown]]]);
  draw();
}
function position(index, share) {
  if (count === 0) return [0, 0, 0];
  const point = k => [points[3 * k], points[3 * k + 1], points[3 * k + 2]];
  if (share <= 0 || index >= count) return point(index === 0 ? from[0] : to[index - 1]);
  const parts = [];
  let whole = 0;
  for (let k = from[index]; k < to[index]; k++) {
    const [a, b] = [point(k), point(k + 1)];
    parts.push([a, b, Math.hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2])]);
    whole += parts[parts.length - 1][2];
  }
  let rest = share * whole;
  for (const [a, b, own] of parts) {
    if (rest <= own && own > 0) return a.map((c, k) => c + (b[k] - c) * rest / own);
    rest -= own;
  }
  return point(to[index]);
}
/* The first of an ascending array that is not below `value`. */
function firstFrom(array, value) {
  let [a, b] = [0, array.length];
  while (a < b) {
    const m = (a + b) >> 1;
    if (array[m] < value) a = m + 1; else b = m;
  }
  return a;
}
function goToLine(number) {
  stop();
  go(Math.min(firstFrom(line, number), count - 1) + 1);
}

/* ---- playing ---- */
let playing = null;
function stop() {
  playing = null;
  element("play").textContent = "Play";
  element("play").setAttribute("aria-pressed", "false");
}
function play() {
  if (playing) return stop();
  const index = Number(slider.value) >= count ? 0 : Number(slider.value);
  playing = { seconds: index > 0 ? time[index - 1] : 0, last: performance.now() };
  element("play").textContent = "Pause";
  element("play").setAttribute("aria-pressed", "true");
  requestAnimationFrame(tick);
}
function tick(stamp) {
  if (!playing) return;
  playing.seconds += Math.max(0, stamp - playing.last) / 1000 * Number(element("speed").value);
  playing.last = stamp;
  if (playing.seconds >= time[count - 1]) {
    stop();
    return go(count);
  }
  const index = firstFrom(time, playing.seconds), before = index > 0 ? time[index - 1] : 0;
  go(index, time[index] > before ? (playing.seconds - before) / (time[index] - before) : 0);
  requestAnimationFrame(tick);
}

/* ---- what is shown ---- */
function toggle(text, colour, note, on, set) {
  const label = document.createElement("label"), input = document.createElement("input");
  input.type = "checkbox";
  input.checked = on;
  input.addEventListener("change", () => { set(input.checked); draw(); });
  label.append(input);
  if (colour) {
    const swatch = document.createElement("i");
    swatch.style.color = colour;
    label.append(swatch);
  }
  label.append(textElement("span", text));
  if (note) label.append(textElement("em", note));
  element("toggles").append(label);
  set(on);
}
function toggles() {
  data.surfaces.forEach((surface, k) => toggle("surface of " + data.operations[surface.operation], null, "", k === data.surfaces.length - 1, on => { surfaces[k].visible = on; }));
  if (data.surfaces.some(s => s.range)) toggle("colours of deviation", null, "", true, on => {
    for (const group of surfaces) for (const mesh of group.children) mesh.material = on && mesh.userData.left ? surfaceMaterials.measured : surfaceMaterials.plain;
    element("legend").hidden = !on;
  });
  const measured = data.surfaces.some(s => s.range);
  for (const path of paths) {
    if (path.pieces === 0) continue;
    let [moves, sum] = [0, 0];
    for (let i = 0; i < count; i++) if (what[i] === path.use) { moves++; sum += time[i] - (i > 0 ? time[i - 1] : 0); }
    toggle(path.name, COLOURS[path.use], moves + " · " + clock(sum), !(measured && path.use !== 0 && path.use !== 2), on => { path.done.visible = on; path.rest.visible = on; path.shown = on; });
  }
  if (data.tools.length > 0) toggle("cutter", null, "", true, on => { cutterShown = on; if (now >= 0) go(Number(slider.value)); });
  if (data.stocks.length > 0) toggle("blank", "#9a7b4f", "", true, on => { stock.visible = on; });
  if (data.edges.length > 0) toggle("part", "#0b4a8f", "", true, on => { part.visible = on; });
}

/* ---- legend and marks ---- */
function legend() {
  const surface = data.surfaces.filter(s => s.range).pop();
  if (!surface) return;
  const bar = element("bar"), pen = bar.getContext("2d"), [low, high] = surface.range;
  for (let x = 0; x < bar.width; x++) {
    pen.fillStyle = "rgb(" + ramp(low + (high - low) * (x + 0.5) / bar.width, surface.range).map(Math.round).join() + ")";
    pen.fillRect(x, 0, 1, bar.height);
  }
  element("legend-unit").textContent = data.small[0];
  const ticks = [0, 0.25, 0.5, 0.75, 1].map(s => s * high);
  if (-low > 0.15 * high) ticks.unshift(low);
  element("ticks").replaceChildren(...ticks.map(value => {
    const tick = textElement("span", minus((value / data.small[1]).toFixed(high / data.small[1] < 10 ? 1 : 0)));
    tick.style.left = (value - low) / (high - low) * bar.width + "px";
    return tick;
  }));
  for (const own of data.surfaces) for (const mark of own.marks) {
    const text = mark.name + " " + little(mark.value), dot = textElement("button", mark.letter), row = textElement("button", mark.letter + "  " + text + ", line " + mark.line);
    dot.className = "mark";
    dot.title = text + "\n" + place(mark.at) + "\nline " + mark.line;
    for (const made of [dot, row]) made.addEventListener("click", () => goToLine(mark.line));
    view.append(dot);
    labels.push({ element: dot, at: new THREE.Vector3(...mark.at) });
    element("marks").append(row);
    element("marks").hidden = false;
  }
}

/* ---- what lies under the pointer ---- */
const ray = new THREE.Raycaster();
let pointer = null;
/* The move nearest to the pointer, within a few pixels. */
function moveAt(x, y) {
  const p = new THREE.Vector3(), q = new THREE.Vector3();
  let best = null, least = 7;
  const matrix = camera.projectionMatrix.clone().multiply(camera.matrixWorldInverse);
  const [w, h] = [view.clientWidth / 2, view.clientHeight / 2];
  const pixel = (k, out) => { out.fromArray(points, 3 * k).applyMatrix4(matrix); out.x = (out.x + 1) * w; out.y = (1 - out.y) * h; };
  for (const path of paths) {
    if (!path.shown) continue;
    for (let k = 0; k < path.pieces; k++) {
      pixel(path.index[2 * k], p);
      pixel(path.index[2 * k + 1], q);
      if (Math.min(p.x, q.x) > x + least || Math.max(p.x, q.x) < x - least || Math.min(p.y, q.y) > y + least || Math.max(p.y, q.y) < y - least) continue;
      const dx = q.x - p.x, dy = q.y - p.y, square = dx * dx + dy * dy;
      const t = square > 0 ? Math.max(0, Math.min(1, ((x - p.x) * dx + (y - p.y) * dy) / square)) : 0;
      const off = Math.hypot(p.x + t * dx - x, p.y + t * dy - y);
      if (off < least) { least = off; best = path.owner[k]; }
    }
  }
  return best;
}
/* The place of a measured surface under the pointer. */
function surfaceAt(x, y) {
  ray.setFromCamera(new THREE.Vector2(x / view.clientWidth * 2 - 1, 1 - y / view.clientHeight * 2), camera);
  const shown = surfaces.filter(g => g.visible).flatMap(g => g.children).filter(m => m.material === surfaceMaterials.measured);
  const hit = ray.intersectObjects(shown, false)[0];
  return hit && { at: hit.point.toArray(), left: hit.object.userData.left[hit.face.a], line: hit.object.userData.line[hit.face.a] };
}
function hover() {
  const [x, y] = pointer, move = moveAt(x, y), spot = move === null ? surfaceAt(x, y) : null;
  tip.hidden = move === null && !spot;
  view.style.cursor = move === null ? "" : "pointer";
  if (tip.hidden) return;
  if (move !== null) tip.replaceChildren("line " + line[move] + " · " + data.uses[what[move]] + "\n", textElement("code", lines[line[move] - 1]));
  else tip.replaceChildren(Number.isNaN(spot.left) ? "not cut" : "left " + little(spot.left) + ", by line " + spot.line + "\n", textElement("code", Number.isNaN(spot.left) ? "" : lines[spot.line - 1]), "\n" + place(spot.at));
  tip.style.left = Math.min(x + 14, view.clientWidth - tip.offsetWidth - 4) + "px";
  tip.style.top = Math.min(y + 14, view.clientHeight - tip.offsetHeight - 4) + "px";
}

/* ---- start ---- */
function start() {
  try {
    renderer = new THREE.WebGLRenderer({ antialias: true });
  } catch (error) {
    element("says").textContent = "This browser shows no WebGL here, which the picture needs; `partwright plot -o x.svg` draws one without.";
    renderer = null;
    return;
  }
  renderer.setClearColor("#eef2f5");
  view.prepend(renderer.domElement);
  controls = new THREE.OrbitControls(camera, renderer.domElement);
  controls.addEventListener("change", draw);
  const canvas = renderer.domElement;
  let pressed = null;
  canvas.addEventListener("pointermove", event => {
    const first = pointer === null;
    pointer = [event.offsetX, event.offsetY];
    if (event.buttons === 0 && first) requestAnimationFrame(() => { if (pointer) hover(); pointer = null; });
    else if (event.buttons !== 0) { pointer = null; tip.hidden = true; }
  });
  canvas.addEventListener("pointerleave", () => { tip.hidden = true; });
  canvas.addEventListener("pointerdown", event => { pressed = [event.offsetX, event.offsetY]; });
  canvas.addEventListener("pointerup", event => {
    if (!pressed || Math.hypot(event.offsetX - pressed[0], event.offsetY - pressed[1]) > 4) return;
    const move = moveAt(event.offsetX, event.offsetY);
    if (move !== null) { stop(); go(move + 1); }
  });
  slider.max = count;
  slider.addEventListener("input", () => { stop(); go(Number(slider.value)); });
  element("play").addEventListener("click", play);
  for (const button of document.querySelectorAll("[data-view]")) button.addEventListener("click", () => look(button.dataset.view));
  new ResizeObserver(resize).observe(view);
  element("sums").textContent = data.post + " · " + lines.filter(l => l.trim() !== "").length + " lines · " + length(data.length, 1) + " " + data.unit[0] + " at feed · " + clock(time[count - 1]);
  legend();
  toggles();
  look("iso");
  const wanted = /^#line=(\d+)$/.exec(location.hash);
  if (wanted) goToLine(Number(wanted[1])); else go(count);
  element("says").remove();
}
start();
