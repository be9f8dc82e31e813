"use strict";
// Times at which paths meet. Units: particle radius a = mass m = time unit T = 1.

const DIAMETER = 2;

// Time until two disks at separation (x, y), with relative velocity (u, v), touch, or Infinity. The
// root by division, and the discriminant from the cross product, avoid cancellation.
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

// Time until a disk with its lowest point at `height`, rising at `speed`, meets a floor that rises for a
// period and then jumps back; `phase` is the time since a stroke began.
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
