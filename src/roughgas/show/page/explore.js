"use strict";
// A choice is {experiment, variant, series, point}; its path is the path of its folder in the results.

const DATA = JSON.parse(document.getElementById("data").textContent);
const at = id => document.getElementById(id);
const minus = text => text.replaceAll("-", "−");

let chosen, averagedOver = "time";

// ---------------------------------------------------------------- the choice

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

// The choice closest to the present one after a change of some of its fields.
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
  draw();
}

function chooseByHash() {
  const path = decodeURIComponent(location.hash.slice(1));
  const choice = CHOICES.get(path);
  choose(choice ?? chosen ?? CHOICES.values().next().value);
  if (path === "" || choice) return;
  at("status").textContent = `There is no point ${path} in this page: another one is shown.`;
  at("status").hidden = false;
}

// ---------------------------------------------------------------- text

// A value with its error in units of the last two digits: 0.3565(30).
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

function residual(value, error, theory) {
  if (theory === null) return "no theory here";
  return withError(value - theory, error, value >= theory ? "+" : "");
}

// Whether R of the experiment is also averaged over collisions.
const hasCollisional = ({ variants }) => variants.some(({ series }) => series.some(({ points }) =>
  points.some(({ collisional }) => (collisional ?? null) !== null)));

const overCollisions = () => averagedOver === "collisions" && hasCollisional(chosen.experiment);

// R of a point and its standard error, averaged as chosen.
const shownR = point => (overCollisions() ? point.collisional ?? null : point.R);
const shownError = point => (overCollisions() ? point.collisional_stderr : point.stderr) ?? 0;

// Whether theory is of averages over collisions, and the points shown are not.
const isUnlike = () => hasCollisional(chosen.experiment) && !overCollisions() && chosen.experiment.over_collisions.startsWith("as");

// The average that is shown, in words.
function average({ over_collisions }) {
  if (overCollisions()) return `averaged over collisions, ${over_collisions}`;
  return isUnlike() ? "averaged over time; theory is of averages over collisions" : "averaged over time";
}

const STEADY = new Map([[true, "found"], [false, "not found"], [null, "not known: too little was measured"]]);

// The name of the theory: "theory: Lun's formula", or "theory of free cooling".
const theoryName = theory => (theory.startsWith("theory") ? theory : `theory: ${theory}`);

// Size of the gas: 160 disks, box 100 × 100 a, packing 0.0503.
function sizeOf({ particles, dimension, box, packing }) {
  const found = [`${particles} ${dimension === 3 ? "spheres" : "disks"}`];
  if (box) found.push(`box ${box.map(String).join(" × ")}${box.includes("open") ? ", sides in a" : "\u00a0a"}`);
  if (packing) found.push(`packing ${packing.toPrecision(3)}`);
  return found.join(", ");
}

function rows(point) {
  const { theory, over_collisions } = chosen.experiment, collisional = point.collisional ?? null;
  const time = collisional === null ? "R" : "R over time";
  const found = [
    [theoryName(theory), point.theory?.toFixed(4) ?? "none here"],
    ...(collisional === null ? [] : [
      [`R over collisions, ${over_collisions}`, withError(collisional, point.collisional_stderr)],
      ["R over collisions − theory", residual(collisional, point.collisional_stderr, point.theory)]]),
    [time, withError(point.R, point.stderr)],
    [`${time} − theory`, residual(point.R, point.stderr, point.theory)],
    [`standard error of ${time}`, point.stderr?.toPrecision(2) ?? "not known"],
    [`95 % interval of ${time}`, interval(point)],
    ["steady state", STEADY.get(point.steady)],
    ["seeds", String(point.seeds)],
    ["collisions", point.collisions.toLocaleString("en")],
    ["CPU time", `${point.seconds.toPrecision(3)} s`],
  ];
  if (point.contact_time) found.push(["contacts changed by the contact-time model",
    `${(100 * point.contact_time).toPrecision(2)} %`]);
  return found;
}

// The name of the third axis, friction.mu, in words.
const parameterOf = experiment => experiment.swept.replaceAll("_", " ").replace(".", ": ");

// The value on the third axis: mu0.1 is the folder of friction.mu = 0.1.
function level(experiment, variant) {
  const parameter = experiment.swept?.split(".").pop();
  return parameter ? variant.name.slice(parameter.length) : "";
}

function showNumbers() {
  const { experiment, variant, series, point } = chosen;
  const which = experiment.swept ? `, ${parameterOf(experiment)} = ${minus(level(experiment, variant))}` : "";
  at("title").textContent = experiment.description;
  at("size").textContent = `${sizeOf(experiment)}${which}`;
  at("scene").replaceChildren(pictureOf(experiment));
  at("averaged").textContent = average(experiment);
  at("point-title").textContent = minus(`r = ${series.r}, β = ${point.beta}`);
  at("numbers").replaceChildren(...rows(point).map(([name, value]) => {
    const row = document.createElement("tr"), head = document.createElement("th");
    head.scope = "row";
    head.textContent = name;
    row.append(head);
    row.insertCell().textContent = value;
    return row;
  }));
  at("target").textContent = `snakemake -j1 --force ${chosen.point.target}`;
  at("command").textContent = chosen.point.command;
}

// ---------------------------------------------------------------- controls

function fill(id, list, label, present) {
  at(id).replaceChildren(...list.map(one => new Option(label(one), one.name ?? "", one === present, one === present)));
}

function showSelects() {
  const { experiment, variant, series, point } = chosen;
  at("variant-label").hidden = experiment.swept === null;
  at("mean-label").hidden = !hasCollisional(experiment);
  at("over-label").hidden = experiment.variants.length < 2;
  at("variant-name").textContent = experiment.swept ? parameterOf(experiment) : "";
  fill("experiment", DATA.experiments, one => one.description, experiment);
  fill("over", ["beta", "third"], one => (one === "beta" ? "β" : at("variant-name").textContent), over);
  fill("variant", experiment.variants, one => level(experiment, one), variant);
  fill("r", variant.series, one => one.r, series);
  fill("beta", series.points, one => minus(one.beta), point);
}

function listen(id, list, key) {
  at(id).addEventListener("change", event =>
    choose(adapted({ [key]: list(chosen)[event.target.selectedIndex] })));
}

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
at("over").addEventListener("change", event => {
  over = ["beta", "third"][event.target.selectedIndex];
  choose(chosen);
});
at("mean").addEventListener("change", event => {
  averagedOver = event.target.value;
  choose(chosen);
});
addEventListener("hashchange", chooseByHash);
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", draw);
addEventListener("beforeprint", () => turnToPaper(true));
addEventListener("afterprint", () => turnToPaper(false));
let wide = innerWidth; // on phones, scrolling changes the height
addEventListener("resize", () => {
  if (innerWidth !== wide) draw();
  wide = innerWidth;
});
chooseByHash();
