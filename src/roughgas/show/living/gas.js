"use strict";
// Event-driven dynamics of rough, inelastic disks, as roughgas.kernel has it: from one contact to the
// next, each time a root in double precision. Units: particle radius a = mass m = time unit T = 1.

const DIAMETER = 2, NOTHING = -1, FLOOR = -2;
const LEAST_DEPARTURE = 1e-3; // from the floor, a/T: any less, and a disk could hit it without end
const LAST_RESORT = 1e-8; // contact time, in T, where the scene has none: no collapse stops the page
const LONG = 1000; // T after which times count from a new beginning, so that none loses digits

// ---------------------------------------------------------------- when paths meet

// Time until two disks at separation (x, y), with relative velocity (u, v), touch, or Infinity. The
// root is formed by division, and the discriminant from the cross product, so that neither cancels.
function timeToContact(x, y, u, v) {
  const b = x * u + y * v;
  if (b >= 0) return Infinity;
  const square = u * u + v * v, gap = x * x + y * y - DIAMETER * DIAMETER, across = x * v - y * u;
  const discriminant = DIAMETER * DIAMETER * square - across * across;
  if (discriminant < 0 && gap > 0) return Infinity;
  const time = Math.max(gap, 0) / (Math.sqrt(Math.max(discriminant, 0)) - b);
  return Math.min(time, -b / square);
}

// First time at which gap + speed t - gravity t^2 / 2 = 0.
function fall(gap, speed, gravity) {
  if (gap <= 0) return speed < 0 ? 0 : 2 * speed / gravity;
  const root = Math.sqrt(speed * speed + 2 * gravity * gap);
  return speed < 0 ? 2 * gap / (root - speed) : (speed + root) / gravity;
}

// When a disk whose lowest point is at `height`, rising at `speed`, meets a floor that rises for a
// period and is back at once; `phase` is the time since a stroke began.
function timeToFloor({ amplitude, period }, gravity, height, speed, phase) {
  const strokeAt = time => {
    const above = height + speed * time - 0.5 * gravity * time * time - amplitude;
    const back = above > 0 ? time + fall(above, speed - gravity * time, gravity) : time;
    return Math.floor((phase + back) / period);
  };
  const rise = amplitude / period;
  for (let stroke = strokeAt(0); ;) {
    const begin = Math.max(0, stroke * period - phase), end = (stroke + 1) * period - phase;
    const surface = rise * (phase + begin - stroke * period);
    const gap = height + speed * begin - 0.5 * gravity * begin * begin - surface;
    const meeting = begin + fall(gap, speed - gravity * begin - rise, gravity);
    if (meeting <= end) return meeting;
    stroke = Math.max(stroke + 1, strokeAt(end));
  }
}

// ---------------------------------------------------------------- the gas

const KEPT = ["x", "y", "vx", "vy", "w"];

class Gas {
  // scene: {box: [width, height or null], inertia, gravity, floor, shear, contact_time, below_r};
  // particles: {x, y, vx, vy, w}, an array each; w is the velocity of the surface, a times the spin.
  constructor(scene, r, beta, particles) {
    const number = particles.x.length;
    Object.assign(this, { scene, r, beta, number });
    for (const name of KEPT) this[name] = Float64Array.from(particles[name]);
    for (const name of ["since", "angle", "next"]) this[name] = new Float64Array(number);
    this.touched = new Float64Array(number).fill(-Infinity); // when each had its last contact
    this.partner = new Int32Array(number); // of the next event, or NOTHING, FLOOR
    this.changes = new Int32Array(number); // of each path
    this.seen = new Int32Array(number); // changes of the partner's path when that was foreseen
    this.now = this.begun = this.collisions = this.halvings = 0;
    this.last = null;
    this.foreseeAll();
  }

  get time() { return this.begun + this.now; }

  // How far the image above has slid.
  slide(time) { return (this.scene.shear || 0) * time; }

  floorHeight() {
    const { floor } = this.scene;
    return floor ? floor.amplitude * (this.now % floor.period) / floor.period : 0;
  }

  // Brings disk i to `time`, and its image that is in the box in its place.
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
      this.vx[i] -= rows * this.slide(1);
    }
    this.x[i] -= width * Math.round(this.x[i] / width - 0.5);
  }

  foreseeAll() { for (let i = 0; i < this.number; i++) this.foresee(i); }

  // Finds the next event of disk i. With the images that are nearest now a contact is found as long as
  // no pair has moved so far that another image could be met: then the disk is looked at again.
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

  // The disk whose event comes next.
  earliest() {
    const { next } = this;
    let i = 0;
    for (let j = 1; j < next.length; j++) if (next[j] < next[i]) i = j;
    return i;
  }

  // Runs to a time, or to a number of collisions; false where `goesOn`, asked now and then, says stop.
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
    const [px, py, turn] = this.response(r, this.beta, x / length, y / length, u,
      this.vy[i] - this.vy[j], this.w[i] + this.w[j], 0.5, 0);
    this.change(i, -px, -py, turn);
    this.change(j, px, py, turn);
    this.last = [i, j];
    this.collisions += 1;
  }

  bounce(i) {
    const { floor } = this.scene;
    this.arrive(i, this.now);
    const v = this.vy[i] - floor.amplitude / floor.period;
    const [px, py, turn] = this.response(floor.restitution, floor.roughness, 0, 1, this.vx[i], v,
      this.w[i], 1, LEAST_DEPARTURE);
    this.change(i, -px, -py, turn);
  }

  // Momentum exchanged and change of each spin, McNamara & Luding (1998), the collision rule: n from the
  // partner to the disk, (u, v) the relative velocity, w the sum of the spins; share is 1/2 between
  // disks and 1 at a wall, from which the disk parts at `least`.
  response(r, beta, nx, ny, u, v, w, share, least) {
    const q = this.scene.inertia, normal = u * nx + v * ny;
    const slipX = u - normal * nx + w * ny, slipY = v - normal * ny - w * nx;
    const turn = share * (1 + beta) / (1 + q);
    const push = share * Math.min((1 + r) * normal, normal - least);
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

  // ---------------------------------------------------------------- what is measured

  // Energies per degree of freedom, Eq. (defE); of a sheared gas without mean flow and mean spin.
  energies() {
    const { number, now, scene: { gravity, shear, inertia, box: [, height] } } = this;
    let squares = 0, spins = 0, spin = 0;
    for (let i = 0; i < number; i++) {
      const passed = now - this.since[i], vy = this.vy[i] - gravity * passed;
      let vx = this.vx[i];
      if (shear) vx -= shear * ((this.y[i] + this.vy[i] * passed) / height - 0.5);
      squares += vx * vx + vy * vy;
      spins += this.w[i] * this.w[i];
      spin += this.w[i];
    }
    if (shear) spins -= spin * spin / number;
    const translation = squares / (4 * number), rotation = inertia * spins / (2 * number);
    const whole = translation + rotation;
    return { translation, rotation, R: whole > 0 ? rotation / whole : 0 };
  }

  // ---------------------------------------------------------------- clocks and units

  // Brings all disks to the present, and lets times count from whole periods of the drive before it.
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
    this.foreseeAll();
  }

  // Doubles all velocities of a gas without a drive, which is the same motion in half the time.
  doubleSpeeds() {
    this.restartClock();
    for (const values of [this.vx, this.vy, this.w]) for (let i = 0; i < this.number; i++) values[i] *= 2;
    this.halvings += 1;
    this.foreseeAll();
  }
}
