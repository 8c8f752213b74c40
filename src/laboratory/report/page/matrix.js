// Techniques by views: times, faults, and the fastest technique of each view.

const VIEWS_ACROSS = 6;  // in one table, so that it fits a sheet of paper

const failures = (row) => [
  row.pairs?.lost > 0 && `${shortCount(row.pairs.lost)} lost${row.overflow > 0 ? " by design" : ""}`,
  row.pairs?.wrong > 0 && `${shortCount(row.pairs.wrong)} wrong`,
  row.pairs?.leaked > 0 && `${shortCount(row.pairs.leaked)} leaked`,
  row.pairs?.acned > 0 && `${shortCount(row.pairs.acned)} acned`,
  row.nan_pixels > 0 && `${shortCount(row.nan_pixels)} NaN`,
].filter(Boolean).join(", ");

function matrixCell(row, pictures) {
  if (!row) return make("td", {}, "\u2013");
  if (row.refused) return make("td", { class: "refused", title: row.refused }, "refused");
  const judged = row.same_surfaces ?? row.error;
  const error = !judged ? "" : judged.bit_identical ? "identical" : judged.max_rel === null ? "not finite" : errorNumber(judged.max_rel);
  const note = { exact: error, lossy: `${error} lossy`, unjudged: `${error} with surfaces`, failed: failures(row) }[pictures.standing];
  const mark = pictures.winner ? "\u2605\u00a0" : "";
  return make("td", { class: `${pictures.standing}${pictures.winner ? " winner" : ""}` },
    make("div", {}, mark + milliseconds(row.frame_ms.median ?? 0)), make("div", { class: "note" }, note));
}

// views: [{ results, page }]; choose(number) is called with the view whose heading is clicked.
function showMatrix(container, views, choose) {
  const names = [...new Set(views.flatMap((view) => view.page.rows.map((row) => row.name)))];
  const tables = [];
  for (let first = 0; first < views.length; first += VIEWS_ACROSS) {
    const shown = views.slice(first, first + VIEWS_ACROSS);
    const heads = shown.map((view, i) => {
      const button = make("button", { type: "button", title: "Show this view below" }, ...view.page.title.split(", ").map((part) => make("span", {}, part)));
      button.addEventListener("click", () => choose(first + i));
      return make("th", { scope: "col" }, button);
    });
    const lines = names.map((name) => make("tr", {}, make("th", { scope: "row" }, nameElement(name)), ...shown.map((view) => {
      const at = view.page.rows.findIndex((row) => row.name === name);
      return matrixCell(view.results.rows[at], view.page.rows[at]);
    })));
    tables.push(make("div", { class: "scrolls" }, make("table", { class: "matrix" },
      make("thead", {}, make("tr", {}, make("td", {}), ...heads)), make("tbody", {}, ...lines))));
  }
  container.replaceChildren(...tables);
}
