// How a point is chosen, and how the page begins.

function fill(id, list, label, present) {
  at(id).replaceChildren(...list.map(one => new Option(label(one), one.name ?? "", one === present, one === present)));
}

function showSelects() {
  const { experiment, variant, series, point } = chosen;
  at("variant-label").hidden = experiment.swept === null;
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

// Plotly is packed, to make the page half as large.
async function start() {
  const packed = Uint8Array.from(atob(at("plotly").textContent.trim()), one => one.charCodeAt(0));
  const program = document.createElement("script");
  const unpacked = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
  program.textContent = await new Response(unpacked).text();
  document.head.append(program);
  chooseByHash();
  at("ratios").on("plotly_click", ({ points: [{ customdata }] }) => {
    if (customdata) choose(drawnRows()[customdata[0]].places[customdata[1]].choice);
  });
  addEventListener("hashchange", chooseByHash);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", draw);
  addEventListener("beforeprint", () => turnToPaper(true));
  addEventListener("afterprint", () => turnToPaper(false));
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
start();
