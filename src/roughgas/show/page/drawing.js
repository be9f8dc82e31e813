// Plots: R and R minus theory over beta, or over the third axis of a sweep; and R over time.

const CONFIG = { responsive: true, displaylogo: false, displayModeBar: matchMedia("(hover: hover)").matches && "hover",
  modeBarButtons: [["toImage", "zoom2d", "pan2d", "resetScale2d"]] };
const CLOCKS = { time: "time in T", collisions_per_particle: "collisions per particle" };
const TONES = { ink: ["#222222", "#e8e8e8"], grey: ["#555555", "#b0b0b0"], grid: ["#eeeeee", "#333840"],
  paper: ["#ffffff", "#16181c"], window: ["#f0f0f0", "#2a2e36"] };
const BRIGHTER = { "#0072B2": "#56B4E9", "#D55E00": "#ff8a4c", "#009E73": "#2bc79a" };
const MARGIN = { l: 64, r: 36, t: 8, b: 48 }; // the buttons are in the right one
const NARROW = 640; // px on paper
let over = "beta", onPaper = false;

const dark = () => !onPaper && matchMedia("(prefers-color-scheme: dark)").matches;
const tone = name => TONES[name][Number(dark())];

function lookOf(index) {
  const look = DATA.looks[index % DATA.looks.length];
  return { ...look, colour: dark() ? BRIGHTER[look.colour] ?? look.colour : look.colour };
}

function draw() {
  drawRatios();
  drawOverTime();
}

// Paper is white, and no wider than it is.
function turnToPaper(begins) {
  onPaper = begins;
  draw();
  for (const id of ["ratios", "over-time"]) {
    if (begins) Plotly.relayout(id, { width: NARROW, height: id === "ratios" ? 460 : 300 });
    else Plotly.relayout(id, { width: null, height: null, autosize: true });
  }
}

const axis = (title, more = {}) => ({ showline: true, mirror: "all", ticks: "inside", automargin: true, linecolor: tone("ink"), zeroline: false,
  gridcolor: tone("grid"), title: { text: title, standoff: 8 }, ...more });

const layout = more => ({ font: { family: "system-ui, DejaVu Sans, sans-serif", size: 13, color: tone("ink") }, margin: MARGIN,
  paper_bgcolor: tone("paper"), plot_bgcolor: tone("paper"), modebar: { orientation: "v" },
  legend: { orientation: "h", y: 1.02, yanchor: "bottom", x: 0 }, ...more });

// ---------------------------------------------------------------- R and R minus theory

// What is drawn with one symbol: all beta at one r, or all values of the third axis at one beta.
function drawnRows() {
  const { experiment, variant, series } = chosen;
  if (over === "beta" || experiment.variants.length < 2) return variant.series.map(one => ({
    label: `r = ${one.r}`, group: one.r, curve: { x: DATA.grid, y: one.curve },
    places: one.points.map(point => ({ x: Number(point.beta), choice: { ...chosen, series: one, point } })),
  }));
  const chosenR = series.r;
  return series.points.map(({ beta }) => {
    const places = experiment.variants.flatMap(one => {
      const same = one.series.find(other => other.r === chosenR), point = same?.points.find(other => other.beta === beta);
      const value = level(experiment, one), x = Number.isNaN(Number(value)) ? value : Number(value);
      return point ? [{ x, choice: { experiment, variant: one, series: same, point } }] : [];
    });
    const curve = { x: places.map(one => one.x), y: places.map(one => one.choice.point.theory) };
    return { label: `β = ${minus(beta)}`, group: beta, curve, places };
  });
}

// of a symbol: filled where a steady state was found, open where not, open with a dot where it is not known
const SUFFIX = new Map([[true, ""], [false, "-open"], [null, "-open-dot"]]);

const difference = point => (point.theory === null ? null : point.R - point.theory);

function points(row, index, valueOf, more) {
  const look = lookOf(index), shown = row.places.map(one => one.choice.point);
  return {
    x: row.places.map(one => one.x), y: shown.map(valueOf), mode: "markers",
    error_y: { array: shown.map(point => point.stderr), thickness: 1, width: 2 },
    marker: { color: look.colour, symbol: shown.map(point => look.symbol + SUFFIX.get(point.steady)),
      size: Math.max(10 - 1.5 * index, 5) },
    customdata: row.places.map((_, number) => [index, number]),
    text: row.places.map(({ choice: { series, point } }) => `r = ${series.r}, β = ${minus(point.beta)}<br>`
      + `R = ${withError(point.R, point.stderr)}<br>R − theory = ${residual(point)}`),
    hovertemplate: "%{text}<extra></extra>", legendgroup: row.group, ...more,
  };
}

function curves(drawn, theory) {
  const line = (row, name, look) => ({ ...row.curve, mode: "lines", hoverinfo: "skip", name, line: look, showlegend: name !== "" });
  const [first, ...others] = drawn;
  if (others.every(one => String(one.curve.y) === String(first.curve.y)))
    return [line(first, theoryName(theory), { color: tone("ink"), width: 1.3 })];
  const lines = drawn.map((row, index) => {
    const { colour, dash } = lookOf(index);
    return { ...line(row, "", { color: colour, dash, width: 1.3 }), legendgroup: row.group };
  });
  const named = { curve: { x: [null], y: [null] } };
  return [...lines, line(named, `lines: ${theoryName(theory)}`, { color: tone("ink"), width: 1.3 })];
}

// The figures' marks, and what they mean: open symbols, and rings where contact times acted.
function marks(drawn) {
  const places = drawn.flatMap(row => row.places), mark = (x, y, name, size, symbol = "circle-open") => ({ x, y, name, mode: "markers", hoverinfo: "skip",
    marker: { symbol, size, color: tone("grey"), line: { width: 1.2 } } });
  const touched = places.filter(one => one.choice.point.contact_time);
  return [
    ...(places.some(one => one.choice.point.steady === false) ? [mark([null], [null], "open: no steady state found", 9)] : []),
    ...(places.some(one => one.choice.point.steady === null) ? [mark([null], [null], "dotted: not known", 9, "circle-open-dot")] : []),
    ...(touched.length ? [mark(touched.map(one => one.x), touched.map(one => one.choice.point.R), "ringed: contact-time model acted", 14)] : []),
  ];
}

function ring(x, value, more) {
  return { x: [x], y: [value], mode: "markers", hoverinfo: "skip", showlegend: false,
    marker: { symbol: "square-open", size: 20, color: tone("ink"), line: { width: 2 } }, ...more };
}

function horizontal(drawn) {
  const values = drawn.flatMap(row => row.places.map(one => one.x));
  if (over === "beta" || chosen.experiment.variants.length < 2) return axis("roughness β", { range: [-1.05, 1.05], anchor: "y2" });
  const wide = values.every(one => one > 0) && Math.max(...values) > 30 * Math.min(...values);
  return axis(parameterOf(chosen.experiment), { anchor: "y2", type: wide ? "log" : undefined });
}

function drawRatios() {
  const { experiment, point } = chosen, drawn = drawnRows();
  const beneath = { yaxis: "y2", showlegend: false };
  const measured = drawn.flatMap((row, index) => [
    points(row, index, one => one.R, { name: row.label }),
    points(row, index, difference, beneath),
  ]);
  const { x } = drawn.flatMap(row => row.places).find(one => one.choice.point === point);
  const traces = [...curves(drawn, experiment.theory), ...measured, ...marks(drawn),
    ring(x, point.R, {}), ring(x, difference(point), beneath)];
  Plotly.react("ratios", traces, layout({ hovermode: "closest", uirevision: `${experiment.name} ${over}`, xaxis: horizontal(drawn),
    yaxis: axis("R", { domain: [0.36, 1] }),
    yaxis2: axis("R − theory", { domain: [0, 0.32], autorangeoptions: { include: 0 }, zeroline: true, zerolinecolor: tone("ink") }),
  }), CONFIG);
}

// ---------------------------------------------------------------- R over time

function windowOf({ measured: [begin, end], at: clock }) {
  if (begin === null) return [];
  return [{ type: "rect", xref: "x", yref: "paper", x0: begin, x1: end ?? clock.at(-1), y0: 0, y1: 1,
    fillcolor: tone("window"), line: { width: 0 }, layer: "below" }];
}

function drawOverTime() {
  const { over_time: series, R } = chosen.point, [first, second, third] = [0, 1, 2].map(lookOf);
  const line = (name, values, look, more) => ({ x: series.at, y: values, mode: "lines", name,
    line: { color: look.colour, dash: look.dash, width: 1.3 }, ...more });
  const cooling = series.clock === "collisions_per_particle";
  const mean = { type: "line", xref: "paper", x0: 0, x1: 1, yref: "y", y0: R, y1: R,
    line: { color: tone("grey"), width: 1, dash: "dot" } };
  Plotly.react("over-time", [
    line("R", series.R, first), line("E<sub>trans</sub>", series.E_trans, second, { yaxis: "y2" }),
    line("E<sub>rot</sub>", series.E_rot, third, { yaxis: "y2" }),
  ], layout({ shapes: [...windowOf(series), mean], xaxis: axis(CLOCKS[series.clock], { anchor: "y2" }),
    yaxis: axis("R", { domain: [0.53, 1] }),
    yaxis2: axis("energy", { domain: [0, 0.47], type: cooling ? "log" : "linear",
      ...(cooling ? { exponentformat: "power" } : { rangemode: "tozero" }) }),
  }), CONFIG);
  const block = series.block > 1 ? `Each value is the mean over a block of ${series.block} samples.`
    : "Every sample is shown.";
  const units = cooling ? "in units of the initial E_trans" : "in m a²/T²";
  at("thinned").textContent = `Seed 1. ${block} Shaded: where R is measured; dotted: R of all seeds. `
    + `Energies are per particle and degree of freedom, ${units}.`;
}
