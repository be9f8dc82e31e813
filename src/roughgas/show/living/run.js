// A running gas, and its record.

const PACE = 16; // speed of a typical disk on the screen, in radii a second
const STILL = 0.25; // share of the initial temperature below which the speeds of a cooling gas are doubled
const DECOUPLED = 1e100; // rotational energy above which they are not doubled: spin outlives translation, R is 1

class Run {
  constructor(scene, material, seed) {
    this.gas = started(scene, material, seed);
    const { translation, rotation } = this.gas.energies(), { floor } = scene;
    this.unit = 2 * translation + rotation;
    this.pace = Math.max(Math.sqrt(2 * translation), floor ? 3 : 0); // typical speed, a/T
    this.thermal = Math.sqrt(2 * this.unit / (3 * this.gas.q)); // typical spin, at equipartition
    this.startRecord();
  }

  // The abscissa of R: time, or collisions per disk in a cooling gas.
  clock() { return this.gas.free() ? 2 * this.gas.collisions / this.gas.number : this.gas.time; }

  // With a floor there are twenty samples a period, and each value is a mean over a period.
  startRecord() {
    const { floor } = this.gas.scene, [step, group] = this.gas.free() ? [0.5, 1] : floor ? [floor.period / 20, 20] : [1, 1];
    const columns = this.gas.free() ? [["R"]] : [["R", "translation", "rotation"], ["sliding", "spinning"]];
    this.record = new Record(this.clock(), step, group, ...columns);
    this.gas.takeContacts();
  }

  // Changes the material at once.
  change(material) {
    Object.assign(this.gas, material).openLedger();
    this.startRecord();
  }

  // Advances by an interval of the gas's time, with samples; returns false if `goesOn` does.
  advance(time, goesOn = () => true) {
    const { gas, record } = this, free = gas.free(), until = gas.time + time;
    while (gas.time < until) {
      const most = free ? Math.ceil(record.due * gas.number / 2) : Infinity;
      const next = free ? until : Math.min(until, record.due);
      if (!gas.run(next - gas.begun, most, goesOn)) return false;
      if (free ? gas.collisions >= most : gas.time > record.due - 1e-9) record.add({ ...gas.energies(), ...gas.takeContacts() });
      if (free && this.isSlow()) gas.doubleSpeeds();
      if (free && gas.collisions < most) break;
    }
    return true;
  }

  isSlow() {
    const { translation, rotation } = this.gas.energies();
    return translation < STILL && rotation < DECOUPLED;
  }

  // Lets `pace` and `thermal`, the typical speed and spin of the picture, follow the gas.
  follow() {
    const { translation, rotation } = this.gas.energies(), typical = Math.sqrt(2 * translation), free = this.gas.free();
    this.pace = free ? typical : this.pace + 0.05 * (Math.max(typical, 1e-6) - this.pace);
    const shown = Math.sqrt(2 * (2 * translation + rotation) / (3 * this.gas.q));
    this.thermal += (free ? 1 : 0.03) * (shown - this.thermal);
  }

  // Kinetic energy over its initial value.
  share() {
    const { translation, rotation } = this.gas.energies();
    return (2 * translation + rotation) / this.unit / 4 ** this.gas.halvings;
  }
}
