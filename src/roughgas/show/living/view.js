"use strict";
// The page around the gas: what is drawn, what is measured, what may be changed.

const SCENES = JSON.parse(document.getElementById("scenes").textContent);
const PACE = 16; // a typical disk moves so many radii in a second
const STILL = 0.25; // share of the first temperature at which the speeds of a cooling gas are doubled
const BUDGET = 11; // ms of a frame that the gas may take
const HISTORY = 480; // values that the graph keeps
const SPINS = [[179, 88, 6], [241, 163, 64], [247, 247, 247], [153, 142, 195], [84, 39, 136]];
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
  say(inTime ? "" : "slower than asked for: many contacts");
  draw();
  if (playing && !document.hidden) frame = requestAnimationFrame(tick);
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
  at("energy-name").textContent = free() ? "energy left, of that at the start" : "energy, over that at the start";
  history.replaceState(null, "", `#${name}/r${gas.r}/beta${gas.beta}`);
  startRecord();
  draw();
}

// ---------------------------------------------------------------- drawing

function colours() {
  const style = getComputedStyle(document.documentElement);
  for (const one of ["ink", "soft", "paper", "line", "accent", "second"]) ink[one] = style.getPropertyValue(`--${one}`).trim();
}

function colourOf(spin) {
  const place = Math.min(Math.max(spin + 2, 0), 3.9999), k = Math.floor(place), share = place - k;
  return `rgb(${SPINS[k].map((one, i) => Math.round(one + share * (SPINS[k + 1][i] - one))).join()})`;
}

// The part of the box that is seen: its height in a, and how much of it lies below the box.
function view() {
  const { box: [width, height], shear, floor } = gas.scene;
  if (floor) return [1.4 * width, 1];
  return shear ? [1.3 * height, 0.15 * height] : [height, 0];
}

function fit() {
  const canvas = at("gas"), [height] = view();
  canvas.style.aspectRatio = `${gas.scene.box[0]} / ${height}`;
  const share = innerWidth < 768 ? 50 : 78; // of the window's height, so that sliders are in sight
  canvas.style.width = `min(100%, ${Math.round(share * gas.scene.box[0] / height)}vh)`;
  for (const one of [canvas, at("graph")]) {
    one.width = Math.round(one.clientWidth * devicePixelRatio);
    one.height = Math.round(one.clientHeight * devicePixelRatio);
  }
}

function draw() {
  drawGas();
  drawGraph();
  const { translation, rotation, R } = gas.energies(), mean = average();
  at("present").textContent = R.toFixed(3);
  at("mean").textContent = mean ? `${mean[0].toFixed(3)} ± ${Math.max(mean[1], 0.0005).toFixed(3)}` : "…";
  at("clock").textContent = clock().toFixed(free() ? 1 : 0);
  at("energy").textContent = ((2 * translation + rotation) / unit / 4 ** gas.halvings).toPrecision(2);
}

function drawGas() {
  const canvas = at("gas"), context = canvas.getContext("2d"), { box: [width, height], gravity, shear, floor } = gas.scene;
  const [seen, below] = view(), scale = canvas.width / width, up = y => canvas.height - (y + below) * scale;
  context.clearRect(0, 0, canvas.width, canvas.height);
  if (floor) {
    context.fillStyle = ink.soft;
    context.fillRect(0, up(gas.floorHeight()), canvas.width, canvas.height);
  }
  for (let i = 0; i < gas.number; i++) {
    const passed = gas.now - gas.since[i];
    let x = gas.x[i] + gas.vx[i] * passed, y = gas.y[i] + gas.vy[i] * passed - 0.5 * gravity * passed * passed;
    const rows = height ? Math.floor(y / height) : 0, angle = gas.angle[i] + gas.w[i] * passed;
    y -= rows * (height || 0);
    x -= rows * gas.slide(gas.now);
    for (const row of height ? [0, -1, 1] : [0]) {
      const Y = y + row * (height || 0), slid = x + row * gas.slide(gas.now), X = slid - width * Math.floor(slid / width);
      if (Y < -below - 1 || Y > seen - below + 1) continue;
      context.globalAlpha = row && shear ? 0.35 : 1;
      for (const column of [0, X < 1 ? 1 : X > width - 1 ? -1 : 0]) {
        disk(context, (X + column * width) * scale, up(Y), scale, angle, gas.w[i] / thermal);
        if (!(X < 1 || X > width - 1)) break;
      }
    }
  }
  context.globalAlpha = 1;
  if (shear) for (const y of [0, height]) line(context, [[0, up(y)], [canvas.width, up(y)]], ink.soft, [6, 6]);
}

function disk(context, x, y, radius, angle, spin) {
  context.beginPath();
  context.arc(x, y, radius, 0, 2 * Math.PI);
  context.fillStyle = colourOf(spin);
  context.strokeStyle = "#333";
  context.lineWidth = Math.max(1, radius / 12);
  context.fill();
  context.stroke();
  context.beginPath();
  context.moveTo(x, y);
  context.lineTo(x + 0.9 * radius * Math.cos(angle), y - 0.9 * radius * Math.sin(angle));
  context.strokeStyle = Math.abs(spin) > 1.2 ? "#fff" : "#333";
  context.lineWidth = Math.max(1.2, radius / 6);
  context.stroke();
}

function line(context, points, colour, dash = [], width = 1) {
  context.beginPath();
  for (const [x, y] of points) context.lineTo(x, y);
  context.strokeStyle = colour;
  context.lineWidth = width * devicePixelRatio;
  context.setLineDash(dash.map(one => one * devicePixelRatio));
  context.stroke();
  context.setLineDash([]);
}

function drawGraph() {
  const canvas = at("graph"), context = canvas.getContext("2d"), dot = devicePixelRatio;
  const [left, top, right, bottom] = [44 * dot, 26 * dot, canvas.width - 10 * dot, canvas.height - 34 * dot];
  const { values, step } = record, highest = Math.max(0.6, theory() + 0.05, ...values);
  const y = R => bottom - (bottom - top) * R / Math.min(highest, 1.02);
  const x = i => left + (right - left) * i / Math.max(values.length - 1, 40);
  context.clearRect(0, 0, canvas.width, canvas.height);
  context.font = `${12 * dot}px system-ui, sans-serif`;
  const write = (text, X, Y, colour, align = "left") => {
    context.fillStyle = colour;
    context.textAlign = align;
    context.fillText(text, X, Y);
  };
  for (const R of [0, 0.25, 0.5, 0.75, 1].filter(one => one <= highest)) write(R.toFixed(2), left - 6 * dot, y(R) + 4 * dot, ink.soft, "right");
  line(context, [[left, top], [left, bottom], [right, bottom]], ink.soft);
  line(context, [[left, y(0.5)], [right, y(0.5)]], ink.soft, [2, 4]);
  line(context, [[left, y(theory())], [right, y(theory())]], ink.second, [8, 4], 1.8);
  line(context, values.map((R, i) => [x(i), y(R)]), ink.accent, [], 1.6);
  const key = [["R", ink.accent, []], ["theory", ink.second, [8, 4]], ["equipartition", ink.soft, [2, 4]]];
  let place = left;
  for (const [text, colour, dash] of key) {
    line(context, [[place, 13 * dot], [place + 24 * dot, 13 * dot]], colour, dash, 1.8);
    write(text, place + 29 * dot, 17 * dot, ink.ink);
    place += 45 * dot + context.measureText(text).width;
  }
  const span = Math.max(values.length - 1, 40) * step;
  write(`${free() ? "collisions per disk" : "time in T"}, since the last change`, (left + right) / 2, canvas.height - 6 * dot, ink.soft, "center");
  write("0", left, bottom + 14 * dot, ink.soft);
  write(span.toPrecision(2) * 1, right, bottom + 14 * dot, ink.soft, "right");
}

// ---------------------------------------------------------------- questions

const QUESTIONS = [
  { asked: "Nearly smooth disks (β = −0.8) with r = 0.8 start without spin, and cool. Where does R settle?",
    shows: ["cooling", 0.8, -0.8], answers: ["near 0: smooth disks hardly turn", "at ½: equal shares", "near 1: spin takes over"], right: 2,
    why: "Each contact takes a fifth of the normal speed, but hardly touches spin. So translation cools faster than rotation, and what energy is left is nearly all spin. Now set r to 0.99." },
  { asked: "A floor shakes perfectly rough disks (β = 1, r = 0.9). It only pushes, and never turns them. Where does R settle?",
    shows: ["vibrated", 0.9, 1], answers: ["near 0: only translation is driven", "near ½", "near 1"], right: 1,
    why: "At β = 1 a contact loses nothing by roughness: it hands energy to and fro until the shares are equal, though all of it comes in as translation. Now lower β." },
  { asked: "The shaken disks have β = 0. Lower r from 0.95 to 0.7, so that they lose much more. What does R do?",
    shows: ["vibrated", 0.95, 0], answers: ["it falls by half", "it hardly changes", "it doubles"], right: 1,
    why: "Lun's formula for driven gases has no r in it. (R measured over time creeps up by some per cent: fast disks collide more often.) In a gas that cools, r matters most: try it." },
];
let asked = 0;

function ask() {
  const { asked: text, answers } = QUESTIONS[asked];
  at("asked").textContent = text;
  at("verdict").textContent = "";
  at("answers").replaceChildren(...answers.map((answer, i) => {
    const button = Object.assign(document.createElement("button"), { type: "button", textContent: answer });
    button.addEventListener("click", () => judge(i));
    return button;
  }));
}

function judge(answer) {
  const { shows, right, why, answers } = QUESTIONS[asked];
  set(...shows);
  speed = Number(at("speed").value = "4");
  playing = true;
  go();
  at("verdict").textContent = `${answer === right ? "Yes." : `No: ${answers[right]}.`} Watch R. ${why}`;
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
