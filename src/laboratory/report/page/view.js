// The part of the page that shows one view: view = { results, page }.

const pictureUrl = (number) => page.pictures[number];
const nameOf = (view, row) => view.page.rows[view.results.rows.indexOf(row)].name;
const referenceOf = (view) =>
    view.results.rows[view.page.reference_row];  // undefined if the reference is no row that ran
const ranRows = (view) => view.results.rows.filter((row) => !row.refused);

// Whether it draws its surfaces in OpenCL and the reference does not.
const hasOwnSurfaces = (view, row) => Boolean(row.error?.silhouettes ?? (row.same_surfaces && row.same_surfaces.reference !== view.results.reference.technique));

function speedUp(view, row) {
  const reference = referenceOf(view);
  return reference && row.frame_ms.median ? reference.frame_ms.median / row.frame_ms.median : null;
}

const brightestInWords = ({ results: { reference } }) => `the brightest channel of ${reference.technique}'s image (${shortNumber(reference.brightest ?? 0)} of radiance)`;

const DIFFERENCE_NOTE = "Difference: black is equal, blue 1e-7 to red 1 of the reference's brightest channel, white NaN.";
const heatNote = (view) => `Lights: black is none, violet few, yellow ${wholeNumber(view.page.heat_top)} and more.`;

// A color of a difference or of a heat map as the number that it stands for.
function differenceValue(color) {
  if (color.every((c) => c === 0)) return "equal";
  if (color.every((c) => c === 255)) return "NaN";
  const share = shareOnRamp(page.difference_legend, color);
  return share === null ? "" : `${share === 0 ? "at most " : ""}${errorNumber(10 ** (7 * share - 7))}`;
}
const heatValue = (top) => (color) => {
  const share = color.every((c) => c === 0) ? 0 : shareOnRamp(page.heat_legend, color);
  return share === null ? "" : share === 1 ? `${wholeNumber(top)} or more` : `about ${wholeNumber(Math.round(share * top))}`;
};

function showPictures(view) {
  const { rows, lit, reference, reduced, folder } = view.page;
  const lights = heatValue(view.page.heat_top);
  const choicesOf = (pick, suffix, note, value) =>
    rows.filter((row) => pick(row) !== null).map((row) => ({ label: row.name + suffix, url: pictureUrl(pick(row)), note, value, reduced }));
  const litChoices = lit ? [{ label: "truly lit", url: pictureUrl(lit.picture), note: heatNote(view), value: lights, reduced }] : [];
  const name = referenceOf(view) ? nameOf(view, referenceOf(view)) : view.results.reference.technique;
  const groups = [
    { label: "Pictures", choices: [...(reference === null ? [] : [{ label: name, url: pictureUrl(reference), reduced }]), ...choicesOf((row) => row.image, "")] },
    { label: "Differences", choices: choicesOf((row) => row.difference, ", difference", DIFFERENCE_NOTE, differenceValue) },
    { label: "Lights per pixel", choices: [...choicesOf((row) => row.listed?.picture ?? null, ", listed", heatNote(view), lights), ...litChoices] },
  ].filter((group) => group.choices.length > 0);
  const fastest = rows.find((row) => row.winner && row.name !== name) ?? rows.find((row) => row.name !== name && row.image !== null);
  // Two pictures that differ: one that is not exact, or else the lights per pixel.
  const inexact = rows.find((row) => row.name !== name && row.image !== null && ["failed", "lossy"].includes(row.standing));
  const listed = fastest?.listed?.picture != null ? `${fastest.name}, listed` : fastest?.name;
  showSlider(groups, name, inexact?.name ?? listed ?? "");
  const { ev, auto } = view.results.exposure ?? {};
  const exposed = ev ? `Pictures are exposed by ${ev > 0 ? "+" : ""}${ev} EV${auto ? ", chosen from the picture" : ""}; figures are not. ` : "";
  byId("reduced").textContent = exposed + (reduced <= 1 ? "" :
    `So that this page stays small, its pictures are shown at 1/${reduced} of their width and height; those in the folder ${folder} are whole. ` +
    "A pixel stands for the mean of its block in a picture, its worst in a difference, its largest count in a heat map.");
}

// Its lists hold every light, but its image lacks more than 1 % of their light.
const shadesLess = (row) => row.unshaded > 0.01;

// A column for each figure of an effect that a row has, by the keys of results.json: "far light: samples".
function figuresOfEffects(view) {
  const words = (key) => key.replaceAll('_', ' '), columns = new Map();
  for (const row of view.results.rows) {
    for (const [effect, figures] of Object.entries(row.effects ?? {})) {
      for (const key of Object.keys(figures)) {
        const title = `${words(effect)}: ${words(key)}`;
        columns.set(title, {title, value: (row) => row.effects?.[effect]?.[key] ?? null, text: shortCount});
      }
    }
  }
  return [...columns.values()];
}

const columnsOf = (view) =>
    [{title: 'Technique', value: (row) => nameOf(view, row), text: nameElement},
     {title: 'Frame, ms', value: (row) => row.frame_ms.median, text: shortNumber},
     {
       title: 'Speed-up',
       value: (row) => speedUp(view, row),
       text: (ratio) => `${shortNumber(ratio)}\u00d7`,
       best: 'high'
     },
     {
       title: 'Listed / lit',
       value: (row) => (row.pairs?.lit ? row.pairs.listed / row.pairs.lit : null),
       text: shortNumber
     },
     {
       title: 'Lost pairs',
       value: (row) => row.pairs?.lost ?? null,
       text: wholeNumber,
       gate: true,
       fails: shadesLess
     },
     {title: 'Wrong pairs', value: (row) => row.pairs?.wrong ?? null, text: wholeNumber, gate: true},
     ...(view.results.rows.some((row) => row.pairs?.leaked !== undefined) ?
             [
               {title: 'Leaked pairs', value: (row) => row.pairs?.leaked ?? null, text: wholeNumber},
               {title: 'Acned pairs', value: (row) => row.pairs?.acned ?? null, text: wholeNumber},
               {title: 'Undecided shadows', value: (row) => row.pairs?.either ?? null, text: shortCount}
             ] :
             []),
     {title: 'NaN pixels', value: (row) => row.nan_pixels, text: wholeNumber, gate: true},
     ...page.measures.map(
         ({key, title}) => ({title, value: (row) => row.same_surfaces?.[key] ?? null, text: errorNumber})),
     ...(view.results.own_surfaces?.error ? [{
       title: 'Surfaces: RMSE',
       value: (row) => (hasOwnSurfaces(view, row) ? view.results.own_surfaces.error.rmse_rel : null),
       text: errorNumber
     }] :
                                            []),
     ...(view.results.rows.some((row) => typeof row.error?.flip_mean === 'number') ?
             [{title: 'FLIP, mean', value: (row) => row.error?.flip_mean ?? null, text: errorNumber}] :
             []),
     {
       title: 'Oracle: largest error',
       value: (row) => (hasOwnSurfaces(view, row) ? null : row.error?.oracle?.max_rel ?? null),
       text: errorNumber
     },
     {
       title: 'Double: RMSE',
       value: (row) => row.error?.surfaces?.rmse_rel ?? null,
       text: errorNumber
     },
     {title: 'Listed pairs', value: (row) => row.pairs?.listed ?? null, text: shortCount},
     {title: 'Light grid', value: (row) => row.memory_bytes.light_grid, text: byteNumber},
     {title: 'G-buffer', value: (row) => row.memory_bytes.gbuffer, text: byteNumber},
     {title: 'Memory, all', value: (row) => row.memory_bytes.total, text: byteNumber},
     ...figuresOfEffects(view),
];

function showErrors(view) {
  const list = byId("errors");
  list.replaceChildren();
  const add = (title, ...lines) =>
    list.append(make("dt", {}, title), make("dd", {}, ...lines.map((line) => make("div", {}, line))));
  const shared = view.results.reference_errors;
  const unknown = "not measured in this run";
  add("Model", `A light's range ends; in nature it does not. With the range window against without, both in double precision: ${shared ? errorInWords(shared.model) : unknown}.`);
  add("Precision", `Every light, in float against double: ${shared ? errorInWords(shared.precision) : unknown}.`);
  const measured = ranRows(view).filter((row) => row.error && row !== referenceOf(view));
  const { technique, pixels } = view.results.reference, all = view.results.size[0] * view.results.size[1];
  const where = pixels < all ? ` at ${wholeNumber(pixels)} of ${wholeNumber(all)} pixels` : "";
  add('Technique', `This picture against every light in float on the same surfaces${where}:`,
      ...measured.map(
          (row) => `${nameOf(view, row)}: ${row.same_surfaces ? `${row.same_surfaces.reference}, ${errorInWords(row.same_surfaces)}` : `not known, ${view.results.own_surfaces?.why_not ?? unknown}`}${
              hasOwnSurfaces(view, row) ? '' : oracleInWords(row.error.oracle, technique)}.`),
      ...(measured.length === 0 ? [unknown + '.'] : []));
  const judged = ranRows(view).filter((row) => row.error?.surfaces?.pixels > 0);
  const own = view.results.own_surfaces?.error;
  if (own) add("Surfaces drawn in OpenCL", `Every light on them against ${technique}: ${errorInWords(own)}${silhouettesInWords(own)}.`);
  if (judged.length > 0) {
    const { surfaces } = view.results.reference;
    add("Surfaces", `Each picture against light and surfaces both in double, textures included, at ${wholeNumber(surfaces.pixels)} pixels:`,
        ...(referenceOf(view) ? [] : [`${technique}: ${surfacesInWords(surfaces)}.`]),
        ...judged.map((row) => `${nameOf(view, row)}: ${surfacesInWords(row.error.surfaces)}.`));
  }
  if (shared?.pixels_left_out > 0) {
    add("Left out", `${wholeNumber(shared.pixels_left_out)} pixels that blended surfaces cover: the oracle does not shade those.`);
  }
}

// Marks are evenly spaced; the first and last are aligned with the ends.
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

function heatFigure(view, heat, what) {
  const top = view.page.heat_top;
  const marks = [0, 1 / 3, 2 / 3].map((share) => lightsNumber(share * top).replace(/\.0$/, ""));
  return figure(heat.picture, `Lights ${what} per pixel: mean ${lightsNumber(heat.mean)}, max ${wholeNumber(heat.max)}`,
    legend(page.heat_legend, [...marks, `${wholeNumber(top)} and more`]));
}

function techniqueCard(view, row) {
  const pictures = view.page.rows[view.results.rows.indexOf(row)], reference = view.results.reference.technique;
  const isReference = row === referenceOf(view), ratio = speedUp(view, row);
  const summary = [
    milliseconds(row.frame_ms.median ?? 0) + " per frame",
    !isReference && ratio !== null && `${shortNumber(ratio)} times the speed of ${reference}`,
    isReference ? "the reference" : row.same_surfaces && `light: ${errorInWords(row.same_surfaces)}`,
    row.inf_pixels > 0 && `${wholeNumber(row.inf_pixels)} pixels pass the largest float`,
    row.overflow > 0 && `${wholeNumber(row.overflow)} lit lights left out${pictures.why_lost}`,
  ];
  const figures = [];
  if (pictures.image !== null) figures.push(figure(pictures.image, "Picture"));
  if (pictures.difference !== null && !isReference) {
    figures.push(figure(pictures.difference, `Difference from ${reference}${hasOwnSurfaces(view, row) ? ", surfaces included" : ""}: black is equal, white is NaN`,
      legend(page.difference_legend, ["1e-7", "1e-6", "1e-5", "1e-4", "1e-3", "0.01", "0.1", "1"])));
  }
  if (pictures.listed) figures.push(heatFigure(view, pictures.listed, "listed"));
  if (pictures.listed && view.page.lit) figures.push(heatFigure(view, view.page.lit, "truly lit"));
  const settings = Object.entries(row.settings).map(([key, value]) => make("div", {}, make("code", {}, `${key} = ${value}`)));
  return make("article", { class: "technique" },
    make("h3", {}, nameOf(view, row), ...(isReference ? [" ", make("span", { class: "tag" }, "reference")] : [])),
    make("p", { class: "summary quiet" }, summary.filter(Boolean).join(" \u00b7 ")),
    make("div", { class: "pictures" }, ...figures),
    ...(settings.length > 0 ? [make("details", {}, make("summary", {}, "Settings"), ...settings)] : []));
}

// One line per refusal, and one per effect and reason with its techniques.
function showSkipped(view) {
  const users = new Map();
  for (const row of ranRows(view)) {
    for (const { effect, why } of row.skipped) {
      const line = `${effect}: ${why}`;
      users.set(line, [...(users.get(line) ?? []), nameOf(view, row)]);
    }
  }
  const refused = view.results.rows.filter((row) => row.refused)
    .map((row) => make("li", {}, make("strong", {}, nameOf(view, row)), ` refused: ${row.refused}`));
  const lines = [...users].map(([line, names]) =>
    make("li", {}, line, names.length < ranRows(view).length ? ` (${names.join(", ")})` : ""));
  const all = [...refused, ...lines];
  byId("skipped").replaceChildren(...(all.length > 0 ? all : [make("li", {}, "Nothing was left out.")]));
}

// Where the plan changed along the camera's path.
const MOST_CHANGES_SHOWN = 20;

// Changes of one frame with one reason are one line: [{ frame, effects, to, why, rows }].
function linesOfChanges(changes) {
  const lines = new Map();
  for (const { frame, effect, to, why, rows } of changes) {
    const key = JSON.stringify([frame, to, why, rows]);
    if (!lines.has(key)) lines.set(key, { frame, effects: [], to, why, rows });
    lines.get(key).effects.push(effect);
  }
  return [...lines.values()];
}

function tableOfChanges(view, lines) {
  const cells = ({ frame, effects, to, why, rows }) => [
    wholeNumber(frame),
    effects.join(", ") + (rows ? ` (${rows.map((row) => view.page.rows[row].name).join(", ")})` : ""),
    `${to === "on" ? "off" : "on"} \u2192 ${to}`,
    why,
  ];
  const line = (tag, texts) => make("tr", {}, ...texts.map((text) => make(tag, {}, text)));
  return make("div", { class: "scrolls" }, make("table", { class: "changes" },
    make("thead", {}, line("th", ["Frame", "Effects", "Plan", "Why"])),
    make("tbody", {}, ...lines.map((change) => line("td", cells(change))))));
}

function showPlanChanges(view) {
  const part = byId("plan-changes"), moving = view.results.moving;
  part.hidden = !moving;
  part.replaceChildren();
  if (!moving) return;
  part.append(make("h3", {}, "Changed along the path"));
  const lines = linesOfChanges(moving.plan_changes);
  const shown = lines.slice(0, MOST_CHANGES_SHOWN), rest = lines.slice(MOST_CHANGES_SHOWN);
  part.append(lines.length > 0 ? tableOfChanges(view, shown) : make("p", {}, "All frames have one plan."));
  if (rest.length === 0) return;
  const summary = make("summary", {}, `${wholeNumber(rest.length)} more`);
  part.append(make("details", {}, summary, tableOfChanges(view, rest)));
}

// Returns the functions that redraw when the width changes.
function showView(view) {
  byId("view-title").textContent = view.page.title;
  byId("verdict").textContent = view.page.verdict;
  byId("choices").replaceChildren(...view.page.choices.map(({ what, name, figure, why, sure }) =>
    make("div", { class: "choice-card" }, make("h3", {}, what), make("p", {}, make("strong", {}, nameElement(name)), ` ${figure}`),
      make("p", {}, why), make("p", { class: "quiet" }, sure))));
  byId("figures").replaceChildren(...view.page.figures.map((line) => make("li", {}, line)));
  for (const element of document.querySelectorAll(".reference")) element.textContent = view.results.reference.technique;
  for (const element of document.querySelectorAll(".brightest")) element.textContent = brightestInWords(view);
  showPictures(view);
  showTable(
      byId('figures-table'), columnsOf(view), view.results.rows,
      (row) =>
          (row === referenceOf(view) ? 'reference' :
               row.overflow > 0      ? 'loses lights by design' :
               shadesLess(row)       ? 'shades less than it lists' :
                                       ''));
  byId("figures-copy").replaceChildren(...copyButtons(() => byId("figures-table")));
  showErrors(view);
  byId("techniques").replaceChildren(...ranRows(view).map((row) => techniqueCard(view, row)));
  showSkipped(view);
  showPlanChanges(view);
  byId("settings-part").hidden = view.page.charts.length === 0;
  const rows = ranRows(view);
  return [
    showBars(byId("time-bars"), byId("pass-legend"), rows.map((row) => timeBar(nameOf(view, row), row)), "the rest of the frame", stageOf, milliseconds, byId("own-scale")),
    showBars(byId("memory-bars"), byId("memory-legend"), rows.map((row) => memoryBar(nameOf(view, row), row)), "scene, images, lights", (name, names) => ({ name, color: colorNumber(names.indexOf(name)) }), byteNumber, null),
    showCharts(byId("settings-charts"), view.page.charts),
  ];
}
