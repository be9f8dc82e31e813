// The page: gases side by side, controls, and the address that stores their settings.

const SCENES = JSON.parse(document.getElementById("scenes-data").textContent);
const BUDGET = 11; // ms a frame for simulation
const at = id => document.getElementById(id);

let panels = [], name = "cooling", seed = 1, playing = !matchMedia("(prefers-reduced-motion: reduce)").matches;
let frame = 0, before = 0, pointed = false, ink = {};

// ---------------------------------------------------------------- simulation

// Driven gases side by side share a clock; each cooling gas has its own.
function advance(seconds) {
  for (const { run } of panels) run.follow();
  const pace = Math.max(...panels.map(({ run }) => run.pace)), begun = Math.min(...panels.map(({ run }) => run.gas.time));
  for (const panel of panels) {
    const { run, run: { gas } } = panel, end = performance.now() + BUDGET / panels.length;
    const time = seconds * Number(at("speed").value) * PACE / Math.max(gas.free() ? run.pace : pace, 1e-6);
    const until = gas.free() ? time : begun + time - gas.time;
    panel.inTime = run.advance(until, () => performance.now() < end);
  }
}

function tick(time) {
  advance(Math.min(0.05, (time - before) / 1000));
  before = time;
  draw();
  if (playing && !document.hidden) frame = requestAnimationFrame(tick);
}

function draw() {
  for (const panel of panels) {
    panel.tell();
    drawGas(panel);
    drawGraph(panel);
  }
}

function go() {
  cancelAnimationFrame(frame);
  at("pause").textContent = playing ? "Pause" : "Play";
  before = performance.now();
  if (playing && !document.hidden) frame = requestAnimationFrame(tick);
}

// ---------------------------------------------------------------- scene and gases

// Shows a scene with a gas of each material, from time 0.
function show(scene, materials, message = "") {
  name = scene;
  document.querySelector(`input[value=${scene}]`).checked = true;
  panels = materials.map((_, i) => panels[i] ?? new Panel(changed));
  panels.forEach((panel, i) => panel.set(materials[i]));
  at("panels").replaceChildren(...panels.map(panel => panel.root));
  document.body.classList.toggle("compared", panels.length > 1);
  at("compare").setAttribute("aria-pressed", panels.length > 1);
  restart();
  at("message").textContent = message;
}

function restart() {
  for (const panel of panels) panel.restart(SCENES[name], seed);
  seed += 1;
  resized();
  changed();
}

function changed() {
  at("message").textContent = "";
  history.replaceState(null, "", `#${[name, ...panels.map(panel => inAddress(panel.material()))].join("/vs/").replace("/vs", "")}`);
  draw();
}

function resized() {
  for (const panel of panels) fit(panel);
  draw();
}

function compare() {
  const materials = panels.map(panel => panel.material());
  show(name, materials.length > 1 ? materials.slice(0, 1) : [...materials, { ...materials[0], r: materials[0].r === 0.99 ? 0.8 : 0.99 }]);
}

function project() {
  at("projector").setAttribute("aria-pressed", document.body.classList.toggle("projected"));
  colours();
  resized();
}

// ---------------------------------------------------------------- the address

// As in #cooling/r0.8/beta-0.8, #vibrated/r0.9/beta0/q1/mu0.3, and #cooling/r0.9/beta0/vs/r0.8/beta0.
function inAddress(material) {
  const kept = Object.entries(material).filter(([key, value]) => key in LIMITS || value !== USUAL[key]);
  return kept.map(([key, value]) => key + value).join("/");
}

// [scene, materials] of an address; throws an Error of one line for an illegal address.
function read(address) {
  const [scene, ...rest] = address.split("/");
  if (!Object.hasOwn(SCENES, scene)) throw Error(`scene = ${scene}: must be one of ${Object.keys(SCENES).join(", ")}`);
  const materials = [{}];
  for (const part of rest) {
    const [, key, text] = /^(r|beta|q|mu)(.+)$/.exec(part) ?? [], value = Number(text);
    if (part === "vs" && materials.length === 1) materials.push({});
    else if (!key) throw Error(`${part}: must be r, beta, q or mu with a number, or once vs`);
    else materials.at(-1)[key] = checked(key, text, value);
  }
  return [scene, materials];
}

function checked(key, text, value) {
  const [least, most] = LIMITS[key] ?? [];
  if (key in LIMITS ? value >= least && value <= most : CHOICES[key].includes(value)) return value;
  throw Error(`${key} = ${text}: must be ${key in LIMITS ? `from ${least} to ${most}` : `one of ${CHOICES[key].join(", ")}`}`);
}

function fromAddress() {
  if (location.hash.length < 2) return show("cooling", [USUAL]);
  try {
    show(...read(decodeURIComponent(location.hash.slice(1))));
  } catch (error) {
    show("cooling", [USUAL], `The address cannot be followed: ${error.message}. This is the first scene.`);
  }
}

// ---------------------------------------------------------------- controls

for (const one of document.querySelectorAll("input[name=scene]")) {
  one.addEventListener("change", () => show(one.value, panels.map(panel => panel.material())));
}
at("pause").addEventListener("click", () => { playing = !playing; go(); });
at("restart").addEventListener("click", restart);
at("compare").addEventListener("click", compare);
at("projector").addEventListener("click", project);
at("another").addEventListener("click", () => { asked = (asked + 1) % QUESTIONS.length; ask(); });
// Controls used by a pointer lose the focus, so that keys reach the page; keyboard users keep it.
addEventListener("pointerdown", () => { pointed = true; }, true);
for (const kind of ["click", "change"]) {
  addEventListener(kind, ({ target }) => { if (pointed && target.matches("button, select, input[type=radio]")) target.blur(); });
}
addEventListener("keydown", event => {
  pointed = false;
  const id = { " ": "pause", c: "compare", p: "projector" }[event.key.toLowerCase()];
  if (!id || event.ctrlKey || event.metaKey || event.altKey || event.target.matches("button, select")) return;
  event.preventDefault();
  at(id).click();
});
addEventListener("resize", resized);
addEventListener("hashchange", fromAddress);
document.addEventListener("visibilitychange", go);
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => { colours(); draw(); });
colours();
fromAddress();
ask();
if (!playing) at("message").textContent = "Still, as your system asks: press Play.";
go();
