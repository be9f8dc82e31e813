// Initial states of gases.

// Generator of random numbers in [0, 1), reproducible by seed (mulberry32).
function generator(seed) {
  return () => {
    seed = (seed + 0x6D2B79F5) | 0;
    let t = Math.imul(seed ^ (seed >>> 15), 1 | seed);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
  };
}

// Disks on random sites of a square lattice, with Maxwellian velocities of temperature 1 around the
// mean flow, and no spin.
function atStart({ box: [width, height], floor, shear, particles }, seed) {
  const random = generator(seed), tall = height || 5 * Math.PI * particles / width;
  const spacing = Math.max(2.0001, Math.sqrt(width * tall / (1.3 * particles)));
  const columns = Math.floor(width / spacing), rows = Math.floor(tall / spacing);
  const sites = Array.from({ length: columns * rows }, (_, k) => k);
  const normal = () => Math.sqrt(-2 * Math.log(1 - random())) * Math.cos(2 * Math.PI * random());
  const found = { x: [], y: [], vx: [], vy: [], w: [] };
  for (let i = 0; i < particles; i++) {
    const other = i + Math.floor(random() * (sites.length - i));
    [sites[i], sites[other]] = [sites[other], sites[i]];
    found.x.push((sites[i] % columns + 0.5) * width / columns);
    found.y.push((Math.floor(sites[i] / columns) + 0.5) * tall / rows + (floor ? floor.amplitude : 0));
    found.vx.push(normal());
    found.vy.push(normal());
    found.w.push(0);
  }
  for (const velocities of [found.vx, found.vy]) {
    const mean = velocities.reduce((sum, one) => sum + one, 0) / particles;
    velocities.forEach((one, i) => { velocities[i] = one - mean; });
  }
  if (shear) found.vx.forEach((one, i) => { found.vx[i] = one + shear * (found.y[i] / height - 0.5); });
  return found;
}

// A gas at time 0; without a drive it is first equilibrated as smooth and elastic disks.
function started(scene, material, seed) {
  const gas = new Gas(scene, material, atStart(scene, seed));
  if (!gas.free()) return gas;
  const { r, beta } = gas;
  Object.assign(gas, { r: 1, beta: -1 }).run(Infinity, 10 * scene.particles);
  Object.assign(gas, { r, beta, collisions: 0 }).openLedger();
  return gas;
}
