// Fills the page from results.json and the pictures, both embedded above.

const results = JSON.parse(byId("results").textContent);
const page = JSON.parse(byId("page").textContent);

const pictureUrl = (number) => page.pictures[number];
const nameOf = (row) => page.rows[results.rows.indexOf(row)].name;
const referenceRow = results.rows.find((row) => row.technique === results.reference && !row.refused);
const speedUp = (row) =>
  referenceRow && row.frame_ms.median ? referenceRow.frame_ms.median / row.frame_ms.median : null;
const passesGates = (row) => row.nan_pixels === 0 && !row.pairs?.lost && !row.pairs?.wrong;
const tagOf = (row) => (row === referenceRow ? "reference" : "");
const ranRows = results.rows.filter((row) => !row.refused);

function showHeader() {
  const scene = results.scene.split(/[/\\]/).pop();
  document.title = `${scene} \u2013 lightgrid compare`;
  byId("scene").textContent = scene;
  const lights = results.rows[0]?.lights;
  byId("view").textContent = [
    `${results.size[0]} \u00d7 ${results.size[1]}`,
    lights && `${wholeNumber(lights.total)} lights, ${wholeNumber(lights.in_view)} in view`,
    `OpenCL: ${results.devices.cl}`,
    `OpenGL: ${results.devices.gl}`,
    `commit ${results.commit}`,
  ].filter(Boolean).join(" \u00b7 ");
  byId("verdict").textContent = page.verdict;
  byId("figures").replaceChildren(...page.figures.map((line) => make("li", {}, line)));
  for (const element of document.querySelectorAll(".reference")) element.textContent = results.reference;
}

const DIFFERENCE_NOTE = "Difference: black is equal, blue 1e-7 to red 1 of the reference's brightest channel, white NaN.";
const heatNote = () => `Lights: black is none, violet few, yellow ${wholeNumber(page.heat_top)} and more.`;

function startSlider() {
  const choicesOf = (pick, suffix, note) =>
    page.rows.filter((row) => pick(row) !== null)
      .map((row) => ({ label: row.name + suffix, url: pictureUrl(pick(row)), note }));
  const lit = page.lit ? [{ label: "truly lit", url: pictureUrl(page.lit.picture), note: heatNote() }] : [];
  const reference = page.reference === null ? [] : [{ label: results.reference, url: pictureUrl(page.reference) }];
  const groups = [
    { label: "Pictures", choices: [...reference, ...choicesOf((row) => row.image, "")] },
    { label: "Differences", choices: choicesOf((row) => row.difference, ", difference", DIFFERENCE_NOTE) },
    { label: "Lights per pixel", choices: [...choicesOf((row) => row.listed?.picture ?? null, ", listed", heatNote()), ...lit] },
  ].filter((group) => group.choices.length > 0);
  const others = ranRows.filter((row) => row !== referenceRow);
  const fastest = others.sort((a, b) => passesGates(b) - passesGates(a) || a.frame_ms.median - b.frame_ms.median)[0];
  showSlider(groups, results.reference, fastest ? nameOf(fastest) : "");
}

const COLUMNS = [
  { title: "Technique", value: nameOf },
  { title: "Frame, ms", value: (row) => row.frame_ms.median, text: shortNumber },
  { title: "Speed-up", value: speedUp, text: (ratio) => `${shortNumber(ratio)}\u00d7`, best: "high" },
  { title: "Listed / lit", value: (row) => (row.pairs?.lit ? row.pairs.listed / row.pairs.lit : null), text: (ratio) => shortNumber(ratio) },
  { title: "Lost pairs", value: (row) => row.pairs?.lost ?? null, text: wholeNumber, gate: true },
  { title: "Wrong pairs", value: (row) => row.pairs?.wrong ?? null, text: wholeNumber, gate: true },
  { title: "NaN pixels", value: (row) => row.nan_pixels, text: wholeNumber, gate: true },
  { title: "Max error, of brightest", value: (row) => row.error?.max_rel ?? null, text: errorNumber },
  { title: "RMSE", value: (row) => row.error?.rmse ?? null, text: errorNumber },
  { title: "Light grid", value: (row) => row.memory_bytes.light_grid, text: byteNumber },
  { title: "G-buffer", value: (row) => row.memory_bytes.gbuffer, text: byteNumber },
  { title: "Memory, all", value: (row) => row.memory_bytes.total, text: byteNumber },
];

function showErrors() {
  const add = (title, ...lines) =>
    byId("errors").append(make("dt", {}, title), make("dd", {}, ...lines.map((line) => make("div", {}, line))));
  const shared = results.reference_errors;
  const unknown = "not measured in this run";
  add("Model", `A light's range ends; in nature it does not. With the range window against without, both in double precision: ${shared ? errorInWords(shared.model) : unknown}.`);
  add("Precision", `Every light, in float against double: ${shared ? errorInWords(shared.precision) : unknown}.`);
  const measured = ranRows.filter((row) => row.error && row !== referenceRow);
  add("Technique", `This picture against ${results.reference}, which shades every light in float:`,
    ...measured.map((row) => `${nameOf(row)}: ${errorInWords(row.error)}.`),
    ...(measured.length === 0 ? [unknown + "."] : []));
  if (shared?.pixels_left_out > 0) {
    add("Left out", `${wholeNumber(shared.pixels_left_out)} pixels that blended surfaces cover: the oracle does not shade those.`);
  }
}

// Marks stand at even steps; the first and last are pulled in to the ends.
function legend(pictureNumber, marks) {
  const placed = marks.map((mark, i) => {
    const share = (100 * i) / (marks.length - 1);
    return make("span", { style: `left:${share}%;translate:-${share}%` }, mark);
  });
  return make("div", { class: "legend" }, make("img", { src: pictureUrl(pictureNumber), alt: "" }), make("div", {}, ...placed));
}

function figure(pictureNumber, caption, ...below) {
  const image = make("img", { src: pictureUrl(pictureNumber), alt: caption });
  const button = make("button", { type: "button", "aria-label": `Enlarge: ${caption}` }, image);
  button.addEventListener("click", () => {
    byId("zoom").querySelector("img").src = image.src;
    byId("zoom").showModal();
  });
  return make("figure", {}, button, make("figcaption", {}, caption), ...below);
}

function heatFigure(heat, what) {
  const top = page.heat_top;
  const marks = [0, 0.25, 0.5, 0.75].map((share) => lightsNumber(share * top).replace(/\.0$/, ""));
  return figure(heat.picture, `Lights ${what} per pixel: mean ${lightsNumber(heat.mean)}, max ${wholeNumber(heat.max)}`,
    legend(page.heat_legend, [...marks, `${wholeNumber(top)} and more`]));
}

function techniqueCard(row) {
  const pictures = page.rows[results.rows.indexOf(row)];
  const isReference = row === referenceRow;
  const summary = [
    milliseconds(row.frame_ms.median ?? 0) + " a frame",
    !isReference && speedUp(row) !== null && `${shortNumber(speedUp(row))} times the speed of ${results.reference}`,
    isReference ? "the reference" : row.error && errorInWords(row.error),
    row.overflow > 0 && `${wholeNumber(row.overflow)} list entries did not fit`,
  ];
  const figures = [];
  if (pictures.image !== null) figures.push(figure(pictures.image, "Picture"));
  if (pictures.difference !== null && !isReference) {
    figures.push(figure(pictures.difference, `Difference from ${results.reference}: black is equal, white is NaN`,
      legend(page.difference_legend, ["1e-7", "1e-6", "1e-5", "1e-4", "1e-3", "0.01", "0.1", "1"])));
  }
  if (pictures.listed) figures.push(heatFigure(pictures.listed, "listed"));
  if (pictures.listed && page.lit) figures.push(heatFigure(page.lit, "truly lit"));
  const settings = Object.entries(row.settings).map(([key, value]) => make("div", {}, make("code", {}, `${key} = ${value}`)));
  return make("article", { class: "technique" },
    make("h3", {}, nameOf(row), ...(tagOf(row) ? [" ", make("span", { class: "tag" }, tagOf(row))] : [])),
    make("p", { class: "summary quiet" }, summary.filter(Boolean).join(" \u00b7 ")),
    make("div", { class: "pictures" }, ...figures),
    ...(settings.length > 0 ? [make("details", {}, make("summary", {}, "Settings"), ...settings)] : []));
}

// One line per effect and reason, with the techniques it holds for.
function showSkipped() {
  const users = new Map();
  for (const row of ranRows) {
    for (const { effect, why } of row.skipped) {
      const line = `${effect}: ${why}`;
      users.set(line, [...(users.get(line) ?? []), nameOf(row)]);
    }
  }
  const lines = [...users].map(([line, names]) =>
    make("li", {}, line, names.length < ranRows.length ? ` (${names.join(", ")})` : ""));
  const refused = results.rows.filter((row) => row.refused)
    .map((row) => make("li", {}, make("strong", {}, nameOf(row)), ` refused: ${row.refused}`));
  const all = [...refused, ...lines];
  byId("skipped").replaceChildren(...(all.length > 0 ? all : [make("li", {}, "Nothing was left out.")]));
}

showHeader();
startSlider();
showTable(byId("figures-table"), COLUMNS, results.rows, tagOf);
showTimeBars(ranRows, ranRows.map(nameOf));
showErrors();
byId("techniques").replaceChildren(...ranRows.map(techniqueCard));
showSkipped();
