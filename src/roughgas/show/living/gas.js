// Event-driven dynamics of rough, inelastic disks, as in roughgas.kernel: from contact to contact, each
// time a root in double precision. Units: particle radius a = mass m = time unit T = 1.

const NOTHING = -1, FLOOR = -2;
const LEAST_DEPARTURE = 1e-3; // from the floor, a/T: at lower speeds a disk could hit it infinitely often
const LAST_RESORT = 1e-8; // contact time, in T, of scenes without one: prevents inelastic collapse
const LONG = 1000; // T after which the clock is reset, so that times keep their digits

const KEPT = ["x", "y", "vx", "vy", "w"];

class Gas {
  // scene: {box: [width, height or null], inertia, gravity, floor, shear, contact_time, below_r};
  // material: {r, beta, q, mu}, q is by default that of the scene; without mu no contact slides;
  // particles: {x, y, vx, vy, w}, all arrays; w is the velocity of the surface, a times the spin.
  constructor(scene, material, particles) {
    const number = particles.x.length;
    Object.assign(this, { scene, number, q: scene.inertia, mu: Infinity }, material);
    for (const name of KEPT) this[name] = Float64Array.from(particles[name]);
    for (const name of ["since", "angle", "next"]) this[name] = new Float64Array(number);
    this.touched = new Float64Array(number).fill(-Infinity); // time of the last contact of each disk
    this.partner = new Int32Array(number); // in the next event: a disk, NOTHING or FLOOR
    this.changes = new Int32Array(number); // number of changes of each disk's path
    this.seen = new Int32Array(number); // `changes` of the partner when the event was predicted
    this.now = this.begun = this.collisions = this.halvings = 0;
    this.last = null;
    this.takeContacts();
    this.openLedger();
    this.foreseeAll();
  }

  get time() { return this.begun + this.now; }

  // Whether the gas has no drive.
  free() { return !this.scene.floor && !this.scene.shear; }

  // Displacement of the image above.
  slide(time) { return (this.scene.shear || 0) * time; }

  floorHeight() {
    const { floor } = this.scene;
    return floor ? floor.amplitude * (this.now % floor.period) / floor.period : 0;
  }

  // Moves disk i to `time`, and back into the box by periods.
  arrive(i, time) {
    const { gravity, box: [width, height] } = this.scene, passed = time - this.since[i];
    this.angle[i] = (this.angle[i] + this.w[i] * passed) % (2 * Math.PI);
    this.x[i] += this.vx[i] * passed;
    this.y[i] += this.vy[i] * passed - 0.5 * gravity * passed * passed;
    this.vy[i] -= gravity * passed;
    this.since[i] = time;
    const rows = height ? Math.round(this.y[i] / height - 0.5) : 0;
    if (rows) {
      this.y[i] -= rows * height;
      this.x[i] -= rows * this.slide(time);
      const faster = rows * this.slide(1);
      this.ledger.driven += faster * (0.5 * faster - this.vx[i]);
      this.vx[i] -= faster;
    }
    this.x[i] -= width * Math.round(this.x[i] / width - 0.5);
  }

  foreseeAll() { for (let i = 0; i < this.number; i++) this.foresee(i); }

  // Predicts the next event of disk i. The nearest images now suffice until a pair has moved so far that
  // another image could be met; then the disk is predicted again.
  foresee(i) {
    const { now, scene: { box: [width, height], gravity, floor }, x, y, vx, vy, since } = this;
    const room = [width / 2 - 2.001, height / 2 - 2.001], U = this.slide(1);
    let first = Infinity, limit = Infinity, partner = NOTHING;
    for (let j = 0; j < this.number; j++) {
      if (j === i) continue;
      const at = Math.max(since[i], since[j]), di = at - since[i], dj = at - since[j];
      let u = vx[j] - vx[i], v = vy[j] - vy[i] - gravity * (dj - di);
      let X = x[j] + vx[j] * dj - x[i] - vx[i] * di;
      let Y = y[j] + vy[j] * dj - y[i] - vy[i] * di - 0.5 * gravity * (dj * dj - di * di);
      const rows = height ? Math.round((Y + v * (now - at)) / height) : 0;
      if (rows) { Y -= rows * height; X -= rows * this.slide(at); u -= rows * U; }
      X -= width * Math.round((X + u * (now - at)) / width);
      const time = at + timeToContact(X, Y, u, v);
      if (time < first) { first = time; partner = j; }
      limit = Math.min(limit, room[0] / Math.abs(u));
      if (height) limit = Math.min(limit, room[1] / Math.abs(v));
    }
    if (floor) {
      const phase = since[i] % floor.period;
      const time = since[i] + timeToFloor(floor, gravity, y[i] - 1, vy[i], phase);
      if (time < first) { first = time; partner = FLOOR; }
    }
    if (now + limit < first) { first = now + limit; partner = NOTHING; }
    this.next[i] = first;
    this.partner[i] = partner;
    if (partner >= 0) this.seen[i] = this.changes[partner];
  }

  // The disk with the earliest event.
  earliest() {
    const { next } = this;
    let i = 0;
    for (let j = 1; j < next.length; j++) if (next[j] < next[i]) i = j;
    return i;
  }

  // Runs to a time, or to a number of collisions; returns false if `goesOn`, called now and then, does.
  run(until, collisions = Infinity, goesOn = () => true) {
    for (let events = 1; this.collisions < collisions; events++) {
      const i = this.earliest(), time = this.next[i], partner = this.partner[i];
      if (time > until) { this.now = until; break; }
      this.now = time;
      if (partner === FLOOR) this.bounce(i);
      else if (partner >= 0 && this.changes[partner] === this.seen[i]) this.collide(i, partner);
      this.foresee(i);
      if (partner >= 0) this.foresee(partner);
      if (events % 64 === 0 && !goesOn()) return false;
    }
    if (this.now > LONG) this.restartClock();
    return true;
  }

  // ---------------------------------------------------------------- contacts

  collide(i, j) {
    const { now, scene: { box: [width, height] } } = this;
    this.arrive(i, now);
    this.arrive(j, now);
    let x = this.x[i] - this.x[j], y = this.y[i] - this.y[j];
    let u = this.vx[i] - this.vx[j];
    const rows = height ? Math.round(y / height) : 0;
    if (rows) { y -= rows * height; x -= rows * this.slide(now); u -= rows * this.slide(1); }
    x -= width * Math.round(x / width);
    const length = Math.hypot(x, y), previous = Math.max(this.touched[i], this.touched[j]);
    const r = now - previous < this.contactTime() ? 1 : this.r;
    const v = this.vy[i] - this.vy[j], w = this.w[i] + this.w[j];
    this.contacts.sliding += ((v * x - u * y) / length) ** 2;
    this.contacts.spinning += w * w;
    const [px, py, turn] = this.response(r, this.beta, x / length, y / length, u, v, w, 0.5, 0);
    this.ledger.driven -= px * rows * this.slide(1);
    this.change(i, -px, -py, turn);
    this.change(j, px, py, turn);
    this.last = [i, j];
    this.collisions += 1;
  }

  bounce(i) {
    const { floor } = this.scene, rise = floor.amplitude / floor.period;
    this.arrive(i, this.now);
    const v = this.vy[i] - rise;
    const [px, py, turn] = this.response(floor.restitution, floor.roughness, 0, 1, this.vx[i], v,
      this.w[i], 1, LEAST_DEPARTURE);
    this.ledger.driven -= py * rise;
    this.change(i, -px, -py, turn);
  }

  // Exchanged momentum and change of each spin, McNamara & Luding (1998), the collision rule: n from the
  // partner to the disk, (u, v) the relative velocity, w the sum of the spins; share is 1/2 between
  // disks and 1 at a wall, which the disk leaves at speed `least` or more. Coulomb friction as in Walton
  // (1993): a contact slides if sticking needs a tangential impulse above mu times the normal one.
  response(r, beta, nx, ny, u, v, w, share, least) {
    const { q, mu } = this, normal = u * nx + v * ny;
    const slipX = u - normal * nx + w * ny, slipY = v - normal * ny - w * nx;
    const slip = Math.hypot(slipX, slipY), most = mu * (1 + r) * (1 + 1 / q) * Math.abs(normal);
    if ((1 + beta) * slip > most) beta = most / slip - 1;
    const turn = share * (1 + beta) / (1 + q);
    const push = share * Math.min((1 + r) * normal, normal - least), parting = normal - push / share;
    this.ledger.lost += 0.5 * share * (normal * normal - parting * parting
      + (1 - beta * beta) * q / (1 + q) * slip * slip);
    return [push * nx + q * turn * slipX, push * ny + q * turn * slipY,
      turn * (nx * slipY - ny * slipX)];
  }

  change(i, px, py, turn) {
    this.vx[i] += px;
    this.vy[i] += py;
    this.w[i] += turn;
    this.touched[i] = this.now;
    this.changes[i] += 1;
  }

  // Contacts of a disk in quicker succession than this are elastic (Luding & McNamara 1998).
  contactTime() {
    const { contact_time: duration, below_r: limit } = this.scene;
    return this.r < limit ? duration : LAST_RESORT;
  }

  // ---------------------------------------------------------------- measurements

  // Energies per degree of freedom, Eq. (defE); of a sheared gas without mean flow and mean spin.
  energies() {
    const { number, q, scene: { shear, box: [, height] } } = this;
    let squares = 0, spins = 0, spin = 0;
    for (let i = 0; i < number; i++) {
      const [seen, vy, y] = this.flight(i), vx = shear ? seen - shear * (y / height - 0.5) : seen;
      squares += vx * vx + vy * vy;
      spins += this.w[i] * this.w[i];
      spin += this.w[i];
    }
    if (shear) spins -= spin * spin / number;
    const translation = squares / (4 * number), rotation = q * spins / (2 * number);
    const whole = translation + rotation;
    return { translation, rotation, R: whole > 0 ? rotation / whole : 0 };
  }

  // Sums A of v_t^2 and B of v_r^2 over the contacts of disks since the last call: R averaged over
  // collisions is q B/(A + q B).
  takeContacts() {
    const { contacts } = this;
    this.contacts = { sliding: 0, spinning: 0 };
    return contacts;
  }

  // ---------------------------------------------------------------- conserved quantities

  // Velocity and height of disk i now: [vx, vy, y].
  flight(i) {
    const passed = this.now - this.since[i], { gravity } = this.scene;
    return [this.vx[i], this.vy[i] - gravity * passed,
      this.y[i] + (this.vy[i] - 0.5 * gravity * passed) * passed];
  }

  // Mean velocity [x, y] minus the flow of shear, in a/T; 0 along axes in which a floor changes momentum.
  drift() {
    const { scene: { floor, shear, box: [, height] }, number } = this;
    let px = 0, py = 0;
    for (let i = 0; i < number; i++) {
      const [vx, vy, y] = this.flight(i);
      px += shear ? vx - shear * (y / height - 0.5) : vx;
      py += vy;
    }
    return [floor && floor.roughness > -1 ? 0 : px / number, floor ? 0 : py / number];
  }

  // Energy of all disks, kinetic and potential, in the box at rest, in m a^2/T^2.
  energy() {
    let sum = 0;
    for (let i = 0; i < this.number; i++) {
      const [vx, vy, y] = this.flight(i);
      sum += 0.5 * (vx * vx + vy * vy + this.q * this.w[i] * this.w[i]) + this.scene.gravity * y;
    }
    return sum;
  }

  openLedger() { this.ledger = { begun: this.energy(), driven: 0, lost: 0 }; }

  // Relative error of the energy balance: energy now, minus initial energy and work of the drive, plus
  // losses in contacts, over initial energy plus losses.
  imbalance() {
    const { begun, driven, lost } = this.ledger;
    return (this.energy() - begun - driven + lost) / (begun + lost);
  }

  // Smallest gap between two disks, or between a disk and the floor, now, in a.
  leastGap() {
    const { now, number, scene: { box: [width, height], floor } } = this;
    const x = Array.from({ length: number }, (_, i) => this.x[i] + this.vx[i] * (now - this.since[i]));
    const y = x.map((_, i) => this.flight(i)[2]);
    let least = floor ? Math.min(...y) - 1 - this.floorHeight() : Infinity;
    for (let i = 0; i < number; i++) {
      for (let j = 0; j < i; j++) {
        const rows = height ? Math.round((y[i] - y[j]) / height) : 0;
        const across = x[i] - x[j] - rows * this.slide(now);
        const gap = Math.hypot(across - width * Math.round(across / width), y[i] - y[j] - rows * (height || 0));
        least = Math.min(least, gap - DIAMETER);
      }
    }
    return least;
  }

  // ---------------------------------------------------------------- clocks and units

  // Moves all disks to the present, removes the momentum, and resets the clock by whole periods of the
  // drive.
  restartClock() {
    const { floor, shear, box } = this.scene;
    const period = floor ? floor.period : shear ? box[0] / Math.abs(shear) : this.now || 1;
    const passed = Math.floor(this.now / period) * period;
    for (let i = 0; i < this.number; i++) {
      this.arrive(i, this.now);
      this.since[i] -= passed;
      this.touched[i] -= passed;
      this.changes[i] += 1;
    }
    this.begun += passed;
    this.now -= passed;
    this.removeDrift();
    this.foreseeAll();
  }

  // Each contact leaves a rounding error in the momentum. In a cooling gas these errors do not decay with
  // the velocities: in the end the drift of the whole gas would hold all energy.
  removeDrift() {
    const [ux, uy] = this.drift();
    for (let i = 0; i < this.number; i++) { this.vx[i] -= ux; this.vy[i] -= uy; }
  }

  // Doubles all velocities of a gas without a drive: the same motion at twice the speed.
  doubleSpeeds() {
    this.restartClock();
    for (const values of [this.vx, this.vy, this.w]) for (let i = 0; i < this.number; i++) values[i] *= 2;
    this.halvings += 1;
    this.openLedger();
    this.foreseeAll();
  }
}
