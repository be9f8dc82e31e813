// A gas on the page: its picture, its sliders, and its numbers.

const LIMITS = { r: [0.6, 1], beta: [-1, 1] };
const CHOICES = { q: [0.1, 0.2, 0.3, 0.5, 1], mu: [Infinity, 1, 0.5, 0.3, 0.2, 0.1, 0.05] };
const CALLED = { 0.5: "0.5 uniform", 1: "1 ring" };
const USUAL = { r: 0.9, beta: 0.5, q: 0.5, mu: Infinity };
const SYMBOLS = { r: "r", beta: "β", q: "q", mu: "μ" };

// Numbers as text; a mean has the digits that its error allows.
const words = text => String(text).replace("-", "−").replace("Infinity", "∞");

function withError(mean, half) {
  if (!(half > 0)) return half === 0 ? `${mean.toFixed(3)}, exact` : `${mean.toFixed(2)} ±\u00a0?`;
  const digits = Math.min(4, Math.max(1, 1 - Math.floor(Math.log10(half))));
  return `${mean.toFixed(digits)} ±\u00a0${Math.max(half, 1e-4).toFixed(digits)}`;
}

class Panel {
  constructor(changed) {
    this.root = at("panel").content.firstElementChild.cloneNode(true);
    for (const key of ["q", "mu"]) {
      this.find(key).append(...CHOICES[key].map(one => new Option(key === "q" && CALLED[one] || words(one), one)));
    }
    for (const key of Object.keys(USUAL)) this.find(key).addEventListener("input", () => { this.change(); changed(); });
    this.set({});
  }

  find(name) { return this.root.querySelector(`.${name}`); }

  say(name, text) {
    const place = this.find(name);
    if (place.textContent !== text) place.textContent = text;
  }

  material() { return Object.fromEntries(Object.keys(USUAL).map(key => [key, Number(this.find(key).value)])); }

  set(material) { for (const [key, value] of Object.entries({ ...USUAL, ...material })) this.find(key).value = value; }

  restart(scene, seed) {
    this.run = new Run(scene, this.material(), seed);
    this.change();
  }

  // Applies the values of the sliders to the gas at once.
  change() {
    const material = this.material();
    this.run.change(material);
    this.say("r-value", material.r.toFixed(2));
    this.say("beta-value", words(material.beta.toFixed(2)));
    const free = this.run.gas.free();
    this.say("clock-name", free ? "collisions per disk" : "time, in T");
    this.inTime = true;
  }

  tell() {
    const { gas, record } = this.run, { R, law, of } = prediction(gas), average = record.average(), left = this.run.share();
    this.say("present", (record.latest ?? gas.energies().R).toFixed(3));
    for (const kind of ["time", "collisions"]) this.say(`of-${kind}`, of === kind && R !== null ? R.toFixed(3) : "none");
    this.say("law", law);
    this.say("mean", average ? withError(average.mean, average.half) : "settling");
    this.say("collisional", this.collisional());
    this.find("row-collisions").hidden = !gas.scene.floor;
    this.say("window", this.window(average));
    this.say("clock", this.run.clock().toFixed(gas.free() ? 1 : 0));
    this.say("energy", left < 1 ? left.toPrecision(2) : left.toFixed(left < 10 ? 1 : 0));
    this.say("remark", this.remark());
  }

  // The window of the mean, and the meaning of its error, as text.
  window(average) {
    if (!average) return "Settling: the mean begins once the gas is steady.";
    const span = [average.from, average.end].map(one => Math.round(one)).join(" to ");
    const error = average.half >= 0 ? "±: 95 % interval" : "error not known yet";
    return this.run.gas.free() ? `Mean from ${span} collisions per disk; ${error}.` : `Means from ${span} T; ${error}.`;
  }

  // R averaged over collisions, the average that theory of a bed predicts, as text.
  collisional() {
    const { gas, record } = this.run, average = record.collisional(gas.q);
    return average ? withError(average.mean, average.half) : record.from === null ? "settling" : "none";
  }

  // A remark on the state of the gas, if it needs one.
  remark() {
    const { gas } = this.run, { scene: { gravity, floor } } = gas;
    if (!this.inTime) return "slower than asked for: many contacts";
    const lossless = gas.r === 1 && (gas.beta === -1 || gas.beta === 1 && gas.mu === Infinity);
    if (!gas.free() && lossless) return "nothing is lost: it heats up without end";
    const [seen, below] = sight(gas);
    const above = gas.y.filter((_, i) => gas.flight(i)[2] > seen - below);
    return floor && above.length > gas.number / 10 ? "many disks are above the picture" : "";
  }
}
