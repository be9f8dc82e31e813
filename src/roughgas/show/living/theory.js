// Theory of the steady R.

// R of a gas with a drive of translation alone: Lun's formula, for any r, if contacts stick; with
// Coulomb friction roughgas.theory.friction_ratio, in closed form for disks.
function lun(beta, q, r = 1, mu = Infinity) {
  const e = (1 + beta) / (2 + 2 * q), slid = q * e * 2 / (mu * (1 + r));
  const theta = 2 * q * e / (1 - e + Math.hypot(1 - e, slid));
  return theta / (1 + theta);
}

// Theory of free cooling: R = 1/(1 + K), where K > 0 solves b K^2 - (2 a + c) K - b/2 = 0; the root is
// written without cancellation. If b = 0, contacts change no spin, and it outlasts translation if contacts dissipate.
function cooling(r, beta, q) {
  const a = (1 - beta * beta) * (1 - q) / (1 + q) - 1 + r * r, b = 2 * q * ((1 + beta) / (1 + q)) ** 2;
  const c = (1 + beta) * (2 * q + q * q * (1 - beta)) / (1 + q) ** 2;
  const linear = 2 * a + c, size = Math.abs(linear) + Math.sqrt(linear * linear + 2 * b * b);
  if (size === 0) return 0;
  return linear > 0 ? 2 * b / (size + 2 * b) : size / (size + b);
}

// Theory for a gas: {R or null, law: its name, of: the average of R that it is of, time or collisions}.
function prediction(gas) {
  const { r, beta, q, mu } = gas, free = gas.free(), overTime = (R, law) => ({ R, law, of: "time" });
  if (beta === -1) {
    if (gas.w.every(one => one === 0)) return overTime(0, "exact: smooth disks never start to spin");
    return free && r < 1 ? overTime(1, "limit: smooth contacts leave spin, take translation")
      : overTime(null, "none: no contact changes a spin, R depends on the start");
  }
  if (free) return mu < Infinity ? overTime(null, "none here for friction: single disks escape") : overTime(cooling(r, beta, q), "theory of free cooling");
  const R = lun(beta, q, r, mu), name = mu < Infinity ? "with friction" : "Lun's formula";
  return gas.scene.shear ? overTime(R, `${name}, without mean flow and mean spin`) : { R, law: `${name}, for averages over collisions`, of: "collisions" };
}
