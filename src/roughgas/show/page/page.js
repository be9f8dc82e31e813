"use strict";
// A choice is {experiment, variant, series, point}; its path is that of its folder in the results.

const DATA = JSON.parse(document.getElementById("data").textContent);
const THEORY = "#222222", GREY = "#555555", FAINT = "#888888";
const CONFIG = { responsive: true, displaylogo: false, displayModeBar: matchMedia("(hover: hover)").matches && "hover",
  modeBarButtons: [["toImage", "zoom2d", "pan2d", "resetScale2d"]] };
const CLOCKS = { time: "time in T", collisions_per_particle: "collisions per particle" };
const at = id => document.getElementById(id);
const minus = text => text.replaceAll("-", "−");

let chosen;

// ---------------------------------------------------------------- what is chosen

function pathOf({ experiment, variant, series, point }) {
  const folder = variant.name === null ? experiment.name : `${experiment.name}/${variant.name}`;
  return `${folder}/r${series.r}/beta${point.beta}`;
}

function* everyChoice() {
  for (const experiment of DATA.experiments)
    for (const variant of experiment.variants)
      for (const series of variant.series)
        for (const point of series.points) yield { experiment, variant, series, point };
}

const CHOICES = new Map([...everyChoice()].map(choice => [pathOf(choice), choice]));

function nearest(list, label, value) {
  const distance = one => Math.abs(Number(label(one)) - Number(value));
  return list.reduce((best, one) => (distance(one) < distance(best) ? one : best));
}

// What comes closest to the present choice where some of it is chosen anew.
function adapted(change) {
  const next = { ...chosen, ...change };
  const { experiment } = next;
  const variant = experiment.variants.find(one => one.name === next.variant.name) ?? experiment.variants[0];
  const series = nearest(variant.series, one => one.r, next.series.r);
  return { experiment, variant, series, point: nearest(series.points, one => one.beta, next.point.beta) };
}

function choose(choice) {
  chosen = choice;
  at("status").hidden = true;
  const hash = `#${pathOf(choice)}`;
  if (decodeURIComponent(location.hash) !== hash) history.replaceState(null, "", hash);
  showSelects();
  showNumbers();
  showCommands();
  drawRatios();
  drawOverTime();
}

function chooseByHash() {
  const path = decodeURIComponent(location.hash.slice(1));
  const choice = CHOICES.get(path);
  choose(choice ?? chosen ?? CHOICES.values().next().value);
  if (path === "" || choice) return;
  at("status").textContent = `There is no point ${path} in this page: another one is shown.`;
  at("status").hidden = false;
}

// ---------------------------------------------------------------- words and numbers

// Such as 0.3565(30): the error in units of the last digits, two of them.
function withError(value, error, sign = "") {
  if (value === null) return "not known";
  if (!error) return `${sign}${value.toFixed(4)} (error not known)`;
  let digits = Math.max(0, 1 - Math.floor(Math.log10(error)));
  if (Math.round(error * 10 ** digits) >= 100) digits -= 1;
  return minus(`${sign}${value.toFixed(digits)}(${Math.round(error * 10 ** digits)})`);
}

function interval({ R, ci95 }) {
  if (ci95 === null) return "not known";
  const digits = Math.max(0, 1 - Math.floor(Math.log10(ci95)));
  return minus(`${(R - ci95).toFixed(digits)} to ${(R + ci95).toFixed(digits)}`);
}

function residual({ R, theory, stderr }) {
  if (theory === null) return "no theory here";
  return withError(R - theory, stderr, R >= theory ? "+" : "");
}

function rows(point) {
  const { theory } = chosen.experiment;
  const found = [
    ["R", withError(point.R, point.stderr)],
    ["standard error", point.stderr?.toPrecision(2) ?? "not known"],
    ["95 % interval", interval(point)],
    [`theory, ${theory}`, point.theory?.toFixed(4) ?? "none here"],
    ["R − theory", residual(point)],
    ["steady state", point.steady ? "found" : "not found"],
    ["seeds", String(point.seeds)],
    ["collisions", point.collisions.toLocaleString("en")],
    ["CPU time", `${point.seconds.toPrecision(3)} s`],
  ];
  if (point.contact_time) found.push(["contacts changed by the contact-time model",
    `${(100 * point.contact_time).toPrecision(2)} %`]);
  return found;
}

// The value on the third axis: mu0.1 is the folder of friction.mu = 0.1.
function level(experiment, variant) {
  const parameter = experiment.swept?.split(".").pop();
  return parameter ? variant.name.slice(parameter.length) : "";
}

function showNumbers() {
  const { experiment, variant, series, point } = chosen;
  const kind = experiment.dimension === 3 ? "spheres" : "disks";
  const which = experiment.swept ? `, ${experiment.swept} = ${level(experiment, variant)}` : "";
  at("title").textContent = minus(`${experiment.name}${which}: ${experiment.particles} ${kind}`);
  at("theory").textContent = experiment.theory;
  at("point-title").textContent = minus(`r = ${series.r}, β = ${point.beta}`);
  at("numbers").replaceChildren(...rows(point).map(([name, value]) => {
    const row = document.createElement("tr"), head = document.createElement("th");
    head.scope = "row";
    head.textContent = name;
    row.append(head);
    row.insertCell().textContent = value;
    return row;
  }));
}

function showCommands() {
  at("target").textContent = `snakemake -j1 --force ${chosen.point.target}`;
  at("command").textContent = chosen.point.command;
}

// ---------------------------------------------------------------- selects

function fill(id, list, label, present) {
  at(id).replaceChildren(...list.map(one => new Option(label(one), "", one === present, one === present)));
}

function showSelects() {
  const { experiment, variant, series, point } = chosen;
  at("variant-label").hidden = experiment.swept === null;
  at("variant-name").textContent = experiment.swept ?? "";
  fill("experiment", DATA.experiments, one => one.name, experiment);
  fill("variant", experiment.variants, one => level(experiment, one), variant);
  fill("r", variant.series, one => one.r, series);
  fill("beta", series.points, one => minus(one.beta), point);
}

function listen(id, list, key) {
  at(id).addEventListener("change", event =>
    choose(adapted({ [key]: list(chosen)[event.target.selectedIndex] })));
}

// ---------------------------------------------------------------- drawings

const TEXT = { family: "system-ui, DejaVu Sans, sans-serif", size: 13, color: THEORY };
const AXIS = { showline: true, mirror: "all", ticks: "inside", linecolor: THEORY, zeroline: false,
  gridcolor: "#eeeeee" };

const axis = (title, more = {}) => ({ ...AXIS, title: { text: title, standoff: 8 }, ...more });

function symbols(series, look) {
  return series.points.map(point => (point.steady ? look.symbol : `${look.symbol}-open`));
}

function points(series, look, index, values, more) {
  return {
    x: series.points.map(point => Number(point.beta)), y: values, mode: "markers",
    error_y: { array: series.points.map(point => point.stderr), thickness: 1, width: 2 },
    marker: { color: look.colour, symbol: symbols(series, look), size: Math.max(10 - 1.5 * index, 5) },
    customdata: series.points.map((_, number) => [index, number]),
    text: series.points.map(point => `r = ${series.r}, β = ${minus(point.beta)}<br>`
      + `R = ${withError(point.R, point.stderr)}<br>R − theory = ${residual(point)}`),
    hovertemplate: "%{text}<extra></extra>", legendgroup: series.r, ...more,
  };
}

function curves(variant, theory) {
  const line = (series, name, look) => ({ x: DATA.grid, y: series.curve, mode: "lines", hoverinfo: "skip",
    name, line: look, showlegend: name !== "" });
  const [first, ...others] = variant.series;
  const same = others.every(one => String(one.curve) === String(first.curve));
  if (same) return [line(first, `theory, ${theory}`, { color: THEORY, width: 1.3 })];
  return variant.series.map((one, index) => {
    const look = DATA.looks[index % DATA.looks.length];
    return { ...line(one, "", { color: look.colour, dash: look.dash, width: 1.3 }), legendgroup: one.r };
  });
}

function ring(point, value, more) {
  return { x: [Number(point.beta)], y: [value], mode: "markers", hoverinfo: "skip", showlegend: false,
    marker: { symbol: "circle-open", size: 17, color: THEORY, line: { width: 2 } }, ...more };
}

function drawRatios() {
  const { experiment, variant, point } = chosen;
  const difference = one => (one.theory === null ? null : one.R - one.theory);
  const beneath = { yaxis: "y2", showlegend: false };
  const measured = variant.series.flatMap((series, index) => {
    const look = DATA.looks[index % DATA.looks.length];
    return [
      points(series, look, index, series.points.map(one => one.R), { name: `r = ${series.r}` }),
      points(series, look, index, series.points.map(difference), beneath),
    ];
  });
  const rings = [ring(point, point.R, {}), ring(point, difference(point), beneath)];
  const traces = [...curves(variant, experiment.theory), ...measured, ...rings];
  Plotly.react("ratios", traces, {
    font: TEXT, margin: { l: 64, r: 12, t: 8, b: 48 }, hovermode: "closest", uirevision: experiment.name,
    legend: { orientation: "h", y: 1.02, yanchor: "bottom", x: 0 },
    xaxis: axis("roughness β", { range: [-1.05, 1.05], anchor: "y2" }),
    yaxis: axis("R", { domain: [0.36, 1] }),
    yaxis2: axis("R − theory", { domain: [0, 0.32], autorangeoptions: { include: 0 },
      zeroline: true, zerolinecolor: THEORY }),
  }, CONFIG);
}

function windowOf({ measured: [begin, end], at: clock }) {
  if (begin === null) return [];
  return [{ type: "rect", xref: "x", yref: "paper", x0: begin, x1: end ?? clock.at(-1), y0: 0, y1: 1,
    fillcolor: "#f0f0f0", line: { width: 0 }, layer: "below" }];
}

function drawOverTime() {
  const { over_time: series, R } = chosen.point;
  const line = (name, values, look, more) => ({ x: series.at, y: values, mode: "lines", name,
    line: { color: look.colour, dash: look.dash, width: 1.3 }, ...more });
  const [first, second, third] = DATA.looks;
  const cooling = series.clock === "collisions_per_particle";
  const mean = { type: "line", xref: "paper", x0: 0, x1: 1, yref: "y", y0: R, y1: R,
    line: { color: GREY, width: 1, dash: "dot" } };
  Plotly.react("over-time", [
    line("R", series.R, first), line("E<sub>trans</sub>", series.E_trans, second, { yaxis: "y2" }),
    line("E<sub>rot</sub>", series.E_rot, third, { yaxis: "y2" }),
  ], {
    font: TEXT, margin: { l: 64, r: 12, t: 8, b: 48 }, shapes: [...windowOf(series), mean],
    legend: { orientation: "h", y: 1.02, yanchor: "bottom", x: 0 },
    xaxis: axis(CLOCKS[series.clock], { anchor: "y2" }),
    yaxis: axis("R", { domain: [0.53, 1] }),
    yaxis2: axis("energy", { domain: [0, 0.47], type: cooling ? "log" : "linear",
      ...(cooling ? { exponentformat: "power" } : { rangemode: "tozero" }) }),
  }, CONFIG);
  const block = series.block > 1 ? `Each value is the mean over a block of ${series.block} samples.`
    : "Every sample is shown.";
  const units = cooling ? "in units of the initial E_trans" : "in m a²/T²";
  at("thinned").textContent = `Seed 1. ${block} Shaded: where R is measured; dotted: R of all seeds. `
    + `Energies are per particle and degree of freedom, ${units}.`;
}

// ---------------------------------------------------------------- from here on

function copy(event) {
  const source = at(event.target.dataset.copies);
  const done = text => {
    event.target.textContent = text;
    setTimeout(() => { event.target.textContent = "Copy"; }, 1500);
  };
  navigator.clipboard.writeText(source.textContent).then(() => done("Copied"), () => {
    getSelection().selectAllChildren(source);
    done("Selected: press Ctrl-C");
  });
}

listen("experiment", () => DATA.experiments, "experiment");
listen("variant", choice => choice.experiment.variants, "variant");
listen("r", choice => choice.variant.series, "series");
listen("beta", choice => choice.series.points, "point");
for (const button of document.querySelectorAll("button[data-copies]")) button.addEventListener("click", copy);
chooseByHash();
at("ratios").on("plotly_click", ({ points: [{ customdata }] }) => {
  if (!customdata) return;
  const series = chosen.variant.series[customdata[0]];
  choose({ ...chosen, series, point: series.points[customdata[1]] });
});
addEventListener("hashchange", chooseByHash);
