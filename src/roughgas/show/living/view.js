// The page around the gas: what is drawn, what is measured, what may be changed.

const SCENES = JSON.parse(document.getElementById("scenes").textContent);
const PACE = 16; // a typical disk moves so many radii in a second
const STILL = 0.25; // share of the first temperature at which the speeds of a cooling gas are doubled
const BUDGET = 11; // ms of a frame that the gas may take
const HISTORY = 480; // values that the graph keeps
const at = id => document.getElementById(id);
const words = number => String(number).replace("-", "−");

let name, gas, seed = 1, playing = !matchMedia("(prefers-reduced-motion: reduce)").matches, frame = 0, before = 0;
let speed = 1, pace = 1, thermal = 1, unit = 1, record, ink = {};

const free = () => !gas.scene.floor && !gas.scene.shear;
// What R is plotted over: time, or collisions per particle in a gas that cools.
const clock = () => (free() ? 2 * gas.collisions / gas.number : gas.time);
const every = () => (free() ? 0.5 : gas.scene.floor ? 0.2 : 1);

function theory() {
  const q = gas.scene.inertia;
  return free() ? cooling(gas.r, gas.beta, q) : lun(gas.beta, q);
}

// ---------------------------------------------------------------- what is measured

// Values of R since the last change; when there are many, pairs of them become one.
function startRecord() {
  record = { due: clock() + every(), step: every(), values: [gas.energies().R], sum: 0, count: 0, pairs: 1 };
}

function note() {
  record.sum += gas.energies().R;
  record.count += 1;
  record.due += every();
  if (record.count < record.pairs) return;
  record.values.push(record.sum / record.count);
  record.sum = record.count = 0;
  if (record.values.length < HISTORY) return;
  const old = record.values;
  record.values = old.filter((_, i) => i % 2 === 0).map((one, i) => (one + (old[2 * i + 1] ?? one)) / 2);
  record.pairs *= 2;
  record.step *= 2;
}

// Mean and standard error over the second half of what was recorded, from eight parts of it.
function average() {
  const half = record.values.slice(Math.ceil(record.values.length / 2)), size = Math.floor(half.length / 8);
  if (size < 2) return null;
  const parts = Array.from({ length: 8 }, (_, k) => half.slice(k * size, (k + 1) * size).reduce((a, b) => a + b) / size);
  const mean = parts.reduce((a, b) => a + b) / 8;
  return [mean, Math.sqrt(parts.reduce((sum, one) => sum + (one - mean) ** 2, 0) / 56)];
}

// ---------------------------------------------------------------- the gas goes on

// Advances by so much of its own time, sampling on the way; false if that takes too long.
function advance(time) {
  const end = performance.now() + BUDGET, until = gas.time + time, inTime = () => performance.now() < end;
  while (gas.time < until) {
    const most = free() ? Math.ceil(record.due * gas.number / 2) : Infinity;
    const next = free() ? until : Math.min(until, record.due);
    if (!gas.run(next - gas.begun, most, inTime)) return false;
    if (free() ? gas.collisions >= most : gas.time > record.due - 1e-9) note();
    if (free() && gas.energies().translation < STILL) gas.doubleSpeeds();
    if (free() && gas.collisions < most) break;
  }
  return true;
}

function tick(time) {
  const passed = Math.min(0.05, (time - before) / 1000);
  before = time;
  const { translation, rotation } = gas.energies();
  const typical = Math.sqrt(2 * translation);
  pace += 0.05 * (Math.max(typical, 1e-6) - pace);
  if (free()) pace = typical;
  const shown = Math.sqrt(2 * (2 * translation + rotation) / (3 * gas.scene.inertia));
  thermal += (free() ? 1 : 0.03) * (shown - thermal);
  const inTime = advance(passed * speed * PACE / Math.max(pace, 1e-6));
  say(remark(inTime));
  draw();
  if (playing && !document.hidden) frame = requestAnimationFrame(tick);
}

// What a person should know of the gas, if anything.
function remark(inTime) {
  if (!inTime) return "slower than asked for: many contacts";
  if (!free() && gas.r === 1 && Math.abs(gas.beta) === 1) return "nothing is lost: it heats up without end";
  const [seen, below] = view(), { gravity, floor } = gas.scene;
  const above = gas.y.filter((y, i) => {
    const passed = gas.now - gas.since[i];
    return y + gas.vy[i] * passed - 0.5 * gravity * passed * passed > seen - below;
  });
  return floor && above.length > gas.number / 10 ? "many disks are above the picture" : "";
}

function say(text) { if (at("note").textContent !== text) at("note").textContent = text; }

function go() {
  cancelAnimationFrame(frame);
  at("pause").textContent = playing ? "Pause" : "Play";
  before = performance.now();
  if (playing && !document.hidden) frame = requestAnimationFrame(tick);
}

function restart() {
  gas = started(SCENES[name], Number(at("r").value), Number(at("beta").value), seed++);
  const { translation, rotation } = gas.energies();
  unit = 2 * translation + rotation;
  pace = Math.max(Math.sqrt(2 * translation), SCENES[name].floor ? 3 : 0);
  thermal = Math.sqrt(2 * unit / (3 * gas.scene.inertia));
  fit();
  change();
}

// Takes over what the sliders say, at once.
function change() {
  gas.r = Number(at("r").value);
  gas.beta = Number(at("beta").value);
  at("r-value").textContent = gas.r.toFixed(2);
  at("beta-value").textContent = words(gas.beta.toFixed(2));
  at("law").textContent = `theory: ${free() ? "free cooling" : "Lun's formula"}`;
  at("theory").textContent = theory().toFixed(3);
  at("clock-name").textContent = free() ? "collisions per disk" : "time, in T";
  history.replaceState(null, "", `#${name}/r${gas.r}/beta${gas.beta}`);
  startRecord();
  draw();
}

// ---------------------------------------------------------------- from here on

function set(scene, r, beta) {
  name = scene;
  document.querySelector(`input[value=${scene}]`).checked = true;
  at("r").value = r;
  at("beta").value = beta;
  restart();
}

function fromAddress() {
  const [, scene, r, beta] = /^#(\w+)\/r([\d.]+)\/beta([-\d.]+)$/.exec(decodeURIComponent(location.hash)) ?? [];
  set(scene in SCENES ? scene : "cooling", r ?? 0.9, beta ?? 0.5);
}

const resized = () => { fit(); draw(); };
for (const id of ["r", "beta"]) at(id).addEventListener("input", change);
for (const one of document.querySelectorAll("input[name=scene]")) {
  one.addEventListener("change", () => set(one.value, at("r").value, at("beta").value));
}
at("speed").addEventListener("change", event => { speed = Number(event.target.value); });
at("pause").addEventListener("click", () => { playing = !playing; go(); });
at("restart").addEventListener("click", restart);
at("another").addEventListener("click", () => { asked = (asked + 1) % QUESTIONS.length; ask(); });
addEventListener("keydown", event => {
  if (event.key !== " " || event.target !== document.body) return;
  event.preventDefault();
  at("pause").click();
});
addEventListener("resize", resized);
addEventListener("hashchange", fromAddress);
document.addEventListener("visibilitychange", go);
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => { colours(); draw(); });
colours();
fromAddress();
ask();
if (!playing) say("still, as your system asks: press Play");
go();
