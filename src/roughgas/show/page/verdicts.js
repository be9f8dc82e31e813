"use strict";
// Filter of the table of verdicts: by words in a statement and its reasons, and by verdict.

const form = document.querySelector("#filter");
const search = form.querySelector("input");
const buttons = [...form.querySelectorAll("button")];
const rows = [...document.querySelectorAll("#verdicts tbody tr")];
let kind = "";

function filter() {
  const words = search.value.toLowerCase().split(/\s+/).filter(Boolean);
  for (const row of rows) {
    const text = row.textContent.toLowerCase();
    row.hidden = (kind && row.dataset.kind !== kind) || !words.every(word => text.includes(word));
  }
  for (const button of buttons) button.setAttribute("aria-pressed", button.dataset.kind === kind);
  form.querySelector("output").value = `${rows.filter(row => !row.hidden).length} of ${rows.length} shown`;
}

function choose(chosen) {
  kind = chosen;
  filter();
}

// Opens the row that a link leads to; the filter must not hide it.
function openTarget() {
  const row = rows.find(({ id }) => id === decodeURIComponent(location.hash.slice(1)));
  if (!row) return;
  if (row.hidden) {
    search.value = "";
    choose("");
  }
  row.querySelector("details").open = true;
  row.scrollIntoView({ block: "center" });
}

for (const button of buttons) button.addEventListener("click", () => choose(button.dataset.kind));
search.addEventListener("input", filter);
form.addEventListener("submit", event => event.preventDefault());
addEventListener("hashchange", openTarget);
let closed = []; // paper shows all reasons
addEventListener("beforeprint", () => {
  closed = [...document.querySelectorAll("details:not([open])")];
  for (const details of closed) details.open = true;
});
addEventListener("afterprint", () => { for (const details of closed) details.open = false; });
form.hidden = false;
filter();
openTarget();
