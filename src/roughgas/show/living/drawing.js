// The gas and the graph, as they are drawn; and the colours of both.

const SPINS = [[179, 88, 6], [241, 163, 64], [247, 247, 247], [153, 142, 195], [84, 39, 136]];

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
  const left = (2 * translation + rotation) / unit / 4 ** gas.halvings;
  at("energy").textContent = left < 1 ? left.toPrecision(2) : left.toFixed(left < 10 ? 1 : 0);
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
