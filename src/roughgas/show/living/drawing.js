// Drawing of the gas and of the graph, and their colours.

const SPINS = [[179, 88, 6], [241, 163, 64], [247, 247, 247], [153, 142, 195], [84, 39, 136]];

function colours() {
  const style = getComputedStyle(document.body);
  for (const one of ["ink", "soft", "paper", "line", "accent", "second", "good"]) ink[one] = style.getPropertyValue(`--${one}`).trim();
}

function colourOf(spin) {
  const place = Math.min(Math.max(spin + 2, 0), 3.9999), k = Math.floor(place), share = place - k;
  return `rgb(${SPINS[k].map((one, i) => Math.round(one + share * (SPINS[k + 1][i] - one))).join()})`;
}

// The visible region: its height in a, and the share of it that lies below the box.
function sight({ scene: { box: [width, height], shear, floor } }) {
  if (floor) return [1.4 * width, 1];
  return shear ? [1.3 * height, 0.15 * height] : [height, 0];
}

function fit({ run: { gas }, root }) {
  const canvas = root.querySelector(".gas"), [height] = sight(gas), shape = gas.scene.box[0] / height;
  canvas.style.aspectRatio = shape;
  canvas.style.width = `min(100%, calc(${shape} * var(--tall)))`;
  for (const one of root.querySelectorAll("canvas")) {
    one.width = Math.round(one.clientWidth * devicePixelRatio);
    one.height = Math.round(one.clientHeight * devicePixelRatio);
  }
}

function drawGas({ run: { gas, thermal }, root }) {
  const canvas = root.querySelector(".gas"), context = canvas.getContext("2d"), { box: [width, height], shear, floor } = gas.scene;
  const [seen, below] = sight(gas), scale = canvas.width / width, up = y => canvas.height - (y + below) * scale;
  context.clearRect(0, 0, canvas.width, canvas.height);
  if (floor) {
    context.fillStyle = ink.soft;
    context.fillRect(0, up(gas.floorHeight()), canvas.width, canvas.height);
  }
  for (let i = 0; i < gas.number; i++) {
    const passed = gas.now - gas.since[i];
    let x = gas.x[i] + gas.vx[i] * passed, y = gas.flight(i)[2];
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

// Entries of the key of the graph: text, colour, dashes and width of its line.
function keyOf({ scene: { floor } }) {
  const means = floor ? [["mean over time", ink.ink, [], 3], ["mean over collisions", ink.good, [], 3]] : [["mean", ink.ink, [], 3]];
  return [["R", ink.accent, [], 1.6], ...means, ["theory", ink.second, [8, 4], 1.8], ["½", ink.soft, [2, 4], 1]];
}

// Draws the key in as many rows as it needs, and returns its height.
function drawKey(context, key, font, write) {
  const length = 1.4 * font, first = 0.5 * font;
  let x = first, y = font;
  for (const [text, colour, dash, thick] of key) {
    const width = length + 0.3 * font + context.measureText(text).width;
    if (x > first && x + width > context.canvas.width - first) { x = first; y += 1.4 * font; }
    line(context, [[x, y], [x + length, y]], colour, dash, thick);
    write(text, x + length + 0.3 * font, y + 0.35 * font, ink.ink);
    x += width + 0.7 * font;
  }
  return y + 0.6 * font;
}

function drawGraph({ run: { gas, record }, root }) {
  const canvas = root.querySelector(".graph"), context = canvas.getContext("2d");
  const dot = devicePixelRatio, font = dot * Math.max(12, 0.75 * parseFloat(getComputedStyle(document.documentElement).fontSize));
  const write = (text, X, Y, colour, align = "left") => {
    context.fillStyle = colour;
    context.textAlign = align;
    context.fillText(text, X, Y);
  };
  context.clearRect(0, 0, canvas.width, canvas.height);
  context.font = `${font}px system-ui, sans-serif`;
  const { rows, width, begun } = record, { R: theory } = prediction(gas), average = record.average(), collisional = record.collisional(gas.q);
  const top = drawKey(context, keyOf(gas), font, write) + 0.6 * font;
  const [left, right, bottom] = [4.4 * font, canvas.width - 0.8 * font, canvas.height - 2.8 * font];
  const most = Math.min(1.02, Math.max(0.6, (theory ?? 0) + 0.05, ...rows.map(([R]) => R)));
  const span = Math.max(rows.length * width, 40 * record.step * (gas.scene.floor ? 20 : 1));
  const y = R => bottom - (bottom - top) * R / most, x = time => left + (right - left) * time / span;
  const level = (R, times, ...look) => line(context, times.map(time => [x(time), y(R)]), ...look);
  const window = average && [average.from - begun, average.end - begun];
  for (const R of [0, 0.25, 0.5, 0.75, 1].filter(one => one <= most)) write(R.toFixed(2), left - 0.5 * font, y(R) + 0.35 * font, ink.soft, "right");
  write("R", 0.6 * font, (top + bottom) / 2, ink.soft);
  line(context, [[left, top], [left, bottom], [right, bottom]], ink.soft);
  level(0.5, [0, span], ink.soft, [2, 4]);
  line(context, rows.map(([R], i) => [x((i + 0.5) * width), y(R)]), ink.accent, [], 1.6);
  if (average) level(average.mean, window, ink.ink, [], 3);
  if (collisional && gas.scene.floor) level(collisional.mean, window, ink.good, [], 3);
  if (theory !== null) level(theory, [0, span], ink.second, [8, 4], 1.8);
  const unit = gas.free() ? "collisions per disk" : "time in T";
  write(canvas.width < 24 * font ? unit : `${unit}, since the last change`, (left + right) / 2, canvas.height - 0.4 * font, ink.soft, "center");
  write("0", left, bottom + 1.15 * font, ink.soft);
  write(Number(span.toPrecision(3)), right, bottom + 1.15 * font, ink.soft, "right");
}
