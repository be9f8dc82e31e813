// Plots by uPlot: R and R minus theory over beta, or over the third axis of a sweep; R and energies over time.
// uPlot has axes, curves, zoom and the values under the cursor; this file draws points with error bars.

const BRIGHTER = { "#0072B2": "#56B4E9", "#D55E00": "#ff8a4c", "#009E73": "#2bc79a" };
const CLOCKS = { time: "time in T", collisions_per_particle: "collisions per particle" };
const CORNERS = { s: [[-0.9, -0.9], [0.9, -0.9], [0.9, 0.9], [-0.9, 0.9]], D: [[-1.2, 0], [0, -1.2], [1.2, 0], [0, 1.2]],
  "^": [[0, -1.2], [1.1, 0.8], [-1.1, 0.8]], v: [[0, 1.2], [1.1, -0.8], [-1.1, -0.8]] };
const SIGNS = { o: "●", s: "■", D: "◆", "^": "▲", v: "▼" };
const FONT = "13px system-ui, DejaVu Sans, sans-serif";
const PLOTS = {};
let over = "beta";

const tone = name => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`);

function lookOf(index) {
  const look = DATA.looks[index % DATA.looks.length];
  return { ...look, colour: tone("paper") === "#fff" ? look.colour : BRIGHTER[look.colour] ?? look.colour };
}

function tick(value) {
  if (value === null) return "";
  const exponent = Math.round(Math.log10(value));
  if (!value || Math.abs(exponent) <= 3 || value !== 10 ** exponent) return minus(String(Number(value.toPrecision(6))));
  return `10${String(exponent).replace(/./g, one => "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"["-0123456789".indexOf(one)])}`;
}

const borderOf = dash => (!dash?.[0] ? "solid" : dash[0] < 4 ? "dotted" : "dashed");

// Powers of ten as ticks, thinned out to fit the axis.
function decades(u, _, low, high) {
  const [first, last] = [Math.ceil(Math.log10(low)), Math.floor(Math.log10(high))], step = Math.ceil((last - first) / 5) || 1;
  return Array.from({ length: Math.floor((last - first) / step) + 1 }, (_, k) => 10 ** (first + k * step));
}

// Replaces an earlier plot, and keeps its zoom if both show the `same`.
function plot(id, { height, x, y, series, data, hooks, legend = false, sync, same }) {
  const before = PLOTS[id], zoomed = before?.same === same ? before.scales : {};
  before?.destroy();
  const axis = more => ({ stroke: tone("ink"), font: FONT, labelFont: FONT, grid: { stroke: tone("grid"), width: 1 }, labelSize: 22,
    ticks: { stroke: tone("ink"), width: 1, size: 5 }, values: (u, splits) => splits.map(tick), ...more });
  PLOTS[id] = new uPlot({
    width: at(id).clientWidth, height, series, hooks, padding: [8, 12, 0, 0], legend: { show: legend, markers: { dash: (u, index) => borderOf(u.series[index].dash) } },
    scales: { x: { time: false, ...x.scale }, y: y.scale ?? {} }, axes: [axis({ size: 30, ...x.axis }), axis({ size: 62, ...y.axis })],
    cursor: { sync: { key: sync, scales: ["x", null] }, drag: { x: true, y: true, uni: 40 }, points: { show: legend } },
  }, data, at(id));
  for (const name of ["x", "y"]) if (zoomed[name]) PLOTS[id].setScale(name, zoomed[name]);
  return Object.assign(PLOTS[id], { same });
}

function draw() {
  drawRatios();
  drawOverTime();
}

// For printing: white background, and the width of the paper.
function turnToPaper(begins) {
  document.documentElement.classList.toggle("on-paper", begins);
  draw();
}

// ---------------------------------------------------------------- R and R minus theory

// Rows of points with the same symbol: all beta at an r, or all values of the third axis at a beta.
function drawnRows() {
  const { experiment, variant, series } = chosen;
  if (over === "beta" || experiment.variants.length < 2) return variant.series.map(one => ({
    label: `r = ${one.r}`, curve: [DATA.grid, one.curve],
    places: one.points.map(point => ({ x: Number(point.beta), choice: { ...chosen, series: one, point } })),
  }));
  const words = experiment.variants.some(one => Number.isNaN(Number(level(experiment, one))));
  return series.points.map(({ beta }) => {
    const places = experiment.variants.flatMap((one, index) => {
      const same = one.series.find(other => other.r === series.r), point = same?.points.find(other => other.beta === beta);
      return point ? [{ x: words ? index : Number(level(experiment, one)), choice: { experiment, variant: one, series: same, point } }] : [];
    }).sort((one, other) => one.x - other.x);
    return { label: `β = ${minus(beta)}`, curve: [places.map(one => one.x), places.map(one => one.choice.point.theory)], places };
  });
}

const difference = point => (point.theory === null || shownR(point) === null ? null : shownR(point) - point.theory);

function mark({ ctx }, { symbol }, x, y, size) {
  ctx.beginPath();
  if (symbol === "o") ctx.arc(x, y, size, 0, 2 * Math.PI);
  else for (const [u, v] of CORNERS[symbol]) ctx.lineTo(x + size * u, y + size * v);
  ctx.closePath();
}

// Filled symbols are steady, open ones are not; open with a dot: not known.
function drawPoint(u, look, size, x, y, half, point) {
  const { ctx } = u, px = uPlot.pxRatio;
  Object.assign(ctx, { strokeStyle: look.colour, fillStyle: look.colour, lineWidth: 1.3 * px });
  ctx.beginPath();
  for (const end of [y - half, y + half]) {
    ctx.moveTo(x, y), ctx.lineTo(x, end);
    ctx.moveTo(x - 3 * px, end), ctx.lineTo(x + 3 * px, end);
  }
  if (half) ctx.stroke();
  mark(u, look, x, y, size * px);
  if (point.steady !== true) ctx.fillStyle = tone("paper");
  ctx.fill(), ctx.stroke();
  ctx.fillStyle = look.colour;
  if (point.steady === null) mark(u, { symbol: "o" }, x, y, 1.5 * px), ctx.fill();
  Object.assign(ctx, { strokeStyle: tone("soft"), lineWidth: 1.2 * px });
  if (point.contact_time) mark(u, { symbol: "o" }, x, y, 8 * px), ctx.stroke();
  Object.assign(ctx, { strokeStyle: tone("ink"), lineWidth: 2 * px });
  if (point === chosen.point) ctx.strokeRect(x - 10 * px, y - 10 * px, 20 * px, 20 * px);
}

function drawPoints(u, rows, valueOf) {
  const { left, top, width, height } = u.bbox;
  u.ctx.save(), u.ctx.setLineDash([]), u.ctx.beginPath(), u.ctx.rect(left, top, width, height), u.ctx.clip();
  rows.forEach(({ places }, index) => {
    for (const { x, choice: { point } } of places) {
      const value = valueOf(point), at = one => u.valToPos(one, "y", true);
      if (value === null) continue;
      const size = Math.max(5 - 0.7 * index, 3);
      drawPoint(u, lookOf(index), size, u.valToPos(x, "x", true), at(value), at(value) - at(value + shownError(point)), point);
    }
  });
  u.ctx.restore();
}

// Shows the numbers of the point under the mouse; a click chooses it.
function listenTo(u, rows, valueOf) {
  const tip = u.over.appendChild(document.createElement("div"));
  let down = [0, 0];
  const away = (event, place) => Math.hypot(u.valToPos(place.x, "x") - event.offsetX, u.valToPos(valueOf(place.choice.point), "y") - event.offsetY);
  const under = event => event.target === u.over && rows.flatMap(row => row.places)
    .filter(place => valueOf(place.choice.point) !== null && away(event, place) < 12)
    .sort((one, other) => away(event, one) - away(event, other))[0];
  tip.className = "tip";
  u.over.addEventListener("mousedown", event => { down = [event.clientX, event.clientY]; });
  u.over.addEventListener("mousemove", event => {
    const place = under(event);
    tip.hidden = !place;
    if (!place) return;
    const { series, point } = place.choice;
    tip.textContent = `r = ${series.r}, β = ${minus(point.beta)}\nR = ${withError(shownR(point), shownError(point))}\n`
      + `R − theory = ${residual(shownR(point), shownError(point), point.theory)}`;
    Object.assign(tip.style, { left: `${Math.min(event.offsetX + 14, u.over.clientWidth - 180)}px`, top: `${event.offsetY + 14}px` });
  });
  u.over.addEventListener("mouseleave", () => { tip.hidden = true; });
  u.over.addEventListener("click", event => {
    const place = under(event);
    if (place && Math.hypot(event.clientX - down[0], event.clientY - down[1]) < 4) choose(place.choice);
  });
  tip.hidden = true;
}

function horizontal(rows) {
  const { experiment } = chosen, values = rows.flatMap(row => row.places.map(one => one.x));
  if (over === "beta" || experiment.variants.length < 2) return { label: "roughness β", scale: { range: padded([-1, 1]) } };
  const named = experiment.variants.map(one => level(experiment, one)), words = named.some(one => Number.isNaN(Number(one)));
  const wide = !words && values.every(one => one > 0) && Math.max(...values) > 30 * Math.min(...values);
  const scale = { distr: wide ? 3 : 1, range: padded(values, wide) };
  const axis = words ? { splits: named.map((_, index) => index), values: () => named } : {};
  return { label: parameterOf(experiment), scale, axis };
}

// Range of an axis: all values and a margin, or the zoomed range.
function padded(values, wide) {
  const [first, last] = [Math.min(...values), Math.max(...values)], margin = 0.05 * (last - first || 1);
  const all = wide ? [first / 1.3, last * 1.3] : [first - margin, last + margin];
  return (u, low, high) => (low > first || high < last ? [low, high] : all);
}

// An entry of the legend: a sign in its colour, or without one a line, and its meaning.
function entry(sign, colour, meaning) {
  const name = document.createElement("span"), shown = name.appendChild(document.createElement("span"));
  Object.assign(shown, { textContent: sign, className: sign ? "sign" : "line", ariaHidden: "true" }).style.color = colour;
  name.append(sign ? ` ${meaning}` : meaning);
  return name;
}

function drawRatios() {
  const rows = drawnRows(), { label, scale, axis } = horizontal(rows), { theory } = chosen.experiment;
  const one = rows.every(row => String(row.curve[1]) === String(rows[0].curve[1]));
  const xs = [...new Set(rows.flatMap(row => [...row.curve[0], ...row.places.map(place => place.x)]))].sort((a, b) => a - b);
  const column = pairs => { const known = new Map(pairs); return xs.map(x => known.get(x) ?? null); };
  // invisible series: they make axes include the error bars
  const bounds = valueOf => rows.flatMap(row => [-1, 1].map(sign => column(row.places.map(({ x, choice: { point } }) =>
    [x, valueOf(point) === null ? null : valueOf(point) + sign * shownError(point)]))));
  const hidden = data => data.map(() => ({ paths: () => null, points: { show: false } }));
  const same = `${chosen.experiment.name} ${over} ${over === "beta" ? chosen.variant.name : chosen.series.r} ${overCollisions()}`;
  const curve = (stroke, dash) => ({ stroke, dash, width: 1.3, spanGaps: true, pxAlign: 0, points: { show: false } });
  const draws = (id, valueOf, lines, more) => {
    const ranges = bounds(valueOf);
    const u = plot(id, { ...more, same, data: [xs, ...lines.map(line => line.data), ...ranges], sync: "ratios",
      series: [{}, ...lines, ...hidden(ranges)], hooks: { draw: [u => drawPoints(u, rows, valueOf)] } });
    listenTo(u, rows, valueOf);
  };
  const curves = (one ? rows.slice(0, 1) : rows).map((row, index) => ({
    ...(one ? curve(tone("ink")) : curve(lookOf(index).colour, lookOf(index).dash)),
    data: column(row.curve[0].map((x, k) => [x, row.curve[1][k]])) }));
  const zero = { ...curve(tone("ink")), width: 1, data: xs.map(() => 0) };
  draws("ratios", shownR, curves, { height: 340, x: { scale, axis: { ...axis, values: () => [] , size: 12 } }, y: { axis: { label: "R" } } });
  draws("residuals", difference, [zero], { height: 190, x: { scale, axis: { ...axis, label } }, y: { axis: { label: "R − theory" } } });
  at("legend").replaceChildren(...rows.map((row, index) => entry(SIGNS[lookOf(index).symbol], lookOf(index).colour, row.label)),
    entry(one ? "" : "lines:", tone("ink"), theoryName(theory) + (isUnlike() ? ", of averages over collisions" : "")));
}

// ---------------------------------------------------------------- R over time

function drawOverTime() {
  const { over_time: series, R } = chosen.point, same = pathOf(chosen), cooling = series.clock === "collisions_per_particle";
  const line = (label, index) => ({ label, stroke: lookOf(index).colour, dash: lookOf(index).dash, width: 1.3, pxAlign: 0, points: { show: false },
    value: (u, value) => (value === null || value === undefined ? "" : minus(value.toPrecision(4))) });
  const shade = u => {
    const [begin, end] = series.measured, { top, height } = u.bbox;
    if (begin === null) return;
    const [left, right] = [Math.max(begin, u.scales.x.min), Math.min(end ?? Infinity, u.scales.x.max)].map(x => u.valToPos(x, "x", true));
    u.ctx.fillStyle = tone("window");
    if (right > left) u.ctx.fillRect(left, top, right - left, height);
  };
  const mean = { ...line("mean R of all seeds", 0), stroke: tone("soft"), dash: [2, 3] };
  const shared = { legend: true, sync: "over-time", same, hooks: { drawClear: [shade] } }, label = CLOCKS[series.clock];
  const clock = { label, value: (u, value) => (value === null || value === undefined ? "" : value.toPrecision(4)) };
  plot("over-time", { ...shared, height: 190, x: {}, y: { axis: { label: "R" } }, data: [series.at, series.R, series.at.map(() => R)],
    series: [clock, line("R of seed 1", 0), mean] });
  const energies = [series.E_trans, series.E_rot].map(values => values.map(one => (cooling && !(one > 0) ? null : one)));
  const many = Math.max(...energies[0]) > 1e5 * Math.min(...energies[0].filter(one => one !== null));
  plot("energies", { ...shared, height: 200, x: { axis: { label } }, data: [series.at, ...energies],
    y: { scale: cooling ? { distr: 3 } : { range: (u, low, high) => [Math.min(low, 0), 1.05 * high || 1] },
      axis: { label: `energy / ${cooling ? "initial E_trans" : "(m a²/T²)"}`, ...(cooling && many ? { splits: decades, filter: (u, splits) => splits } : {}) } },
    series: [clock, line("translation, E_trans", 1), line("rotation, E_rot", 2)] });
  const block = series.block > 1 ? `Each value is the mean over a block of ${series.block} samples.`
    : "Every sample is shown.";
  const units = cooling ? "in units of the initial E_trans" : "in m a²/T²";
  at("thinned").textContent = `Seed 1. ${block} Shaded: where R is measured; dotted: mean R of all seeds. `
    + `Energies are per particle and degree of freedom, ${units}.`;
}
