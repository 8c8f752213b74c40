// Fills the page from the answer, embedded above.

const state = { scene: page.scenes[0]?.key, points: [], x: quantity(page.default_time), y: frontQuantity("total"), clock: quantity(page.default_time).clock, reference: "total", hidden: new Set(), selected: null };
let drawFront = null;

const sceneTitle = (key) => page.scenes.find((scene) => scene.key === key).title;

function showHeader() {
  const scenes = page.scenes.map((scene) => scene.title).join(", ");
  document.title = `${scenes} \u2013 lightgrid frontier`;
  byId("scenes").textContent = scenes;
  const first = page.machines[0];
  byId("sweep").textContent = [`${wholeNumber(page.points.length)} points`, `OpenCL: ${first.cl_device}`, `OpenGL: ${first.gl_device}`,
    `commit ${page.commit}`, `seed ${page.seed}`].join(" \u00b7 ");
  for (const element of document.querySelectorAll(".baseline")) element.textContent = page.baseline;
}

function pointButton(point, text) {
  const button = make("button", { type: "button", class: "link" }, text);
  button.addEventListener("click", () => {
    chooseScene(point.scene);
    choosePoint(point);
    byId("chosen").scrollIntoView({ block: "nearest" });
  });
  return button;
}

function withinCell(best) {
  if (!best) return make("td", { class: "quiet" }, "\u2013");
  const point = page.points[best.point];
  return make("td", {}, make("div", {}, pointButton(point, nameElement(point.label))),
    make("div", { class: "note" }, `${intervalInWords(best.relative_time, "\u00d7")}, ${milliseconds(state.clock.ms(point).median)}`),
    make("div", { class: "note" }, best.probability === null ? "how surely it is the cheapest: not measured" : `the cheapest with a probability of ${probabilityText(best.probability)}`),
    ...(best.p_cheapest_views === null ? [] : [make("div", { class: "note" }, `over other views ${probabilityText(best.p_cheapest_views)}`)]));
}

function showBestWithin() {
  const all = state.clock.within.filter((best) => best.of === state.reference);
  const errors = [...new Set(all.map((best) => best.flip))].sort((a, b) => b - a);
  const head = page.scenes.map((scene) => make("th", { scope: "col" }, scene.title));
  const lines = errors.map((error) => make("tr", {}, make("th", { scope: "row" }, String(error)),
    ...page.scenes.map((scene) => withinCell(all.find((best) => best.scene === scene.key && best.flip === error)))));
  byId("within").replaceChildren(make("thead", {}, make("tr", {}, make("td", {}, "FLIP"), ...head)), make("tbody", {}, ...lines));
  byId("within").closest("section").hidden = errors.length === 0;
}

// Errors of the answer's sentence, from the largest.
const ANSWERS = [[0.05, "whose difference is hard to see"], [0.001, "without a visible difference"]];

function showVerdict() {
  const found = ANSWERS.map(([flip, words]) => ({ flip, words,
    best: state.clock.within.find((best) => best.of === state.reference && best.scene === state.scene && best.flip === flip) })).filter(({ best }) => best);
  const same = found.length === 2 && found[0].best.point === found[1].best.point;
  const parts = (same ? found.slice(1) : found).flatMap(({ flip, words, best }, i) => [i ? "; " : "", nameElement(page.points[best.point].label),
    ` is the fastest setting ${words} (FLIP at most ${flip}): ${threeDigits(best.relative_time.median ?? best.relative_time.estimate)} times the time of ${page.baseline}`]);
  byId("verdict").replaceChildren(`In ${sceneTitle(state.scene)}, `, ...parts, same ? `; none within a FLIP of ${found[0].flip} is faster.` : ".");
  byId("verdict").hidden = parts.length === 0;
}

// The point of a step of a family of lights: "visibility, 1,000 lights, 9.98 at a pixel".
const withoutStep = (label) => label.replace(/, [\d,]+ lights, \S+ at a pixel$/, "");

function causesInWords(failures) {
  return [...new Set(failures.map(({ cause }) => cause))].map((cause) => {
    const steps = failures.filter((failure) => failure.cause === cause).length;
    return steps > 1 ? `${cause} in ${steps} steps` : cause;
  }).join(", ");
}

function showFailures() {
  byId("failures-part").hidden = page.failures.length === 0;
  const labels = [...new Set(page.failures.map((failure) => withoutStep(failure.label)))];
  const cell = (label, scene) => {
    const of = page.failures.filter((failure) => withoutStep(failure.label) === label && failure.scene === scene);
    if (of.length === 0) return make("td", { class: "fine" }, page.points.some((p) => p.label === label && p.scene === scene) ? "\u2713" : "\u2013");
    return make("td", { title: of.map((failure) => failure.why).join("; ") }, causesInWords(of));
  };
  byId("failures").replaceChildren(
    make("thead", {}, make("tr", {}, make("td", {}), ...page.scenes.map((scene) => make("th", { scope: "col" }, scene.title)))),
    make("tbody", {}, ...labels.map((label) => make("tr", {}, make("th", { scope: "row" }, nameElement(label)),
      ...page.scenes.map((scene) => cell(label, scene.key))))));
  byId("reasons").replaceChildren(...page.failures.map((failure) =>
    make("li", {}, make("strong", {}, failure.label), ` in ${sceneTitle(failure.scene)}: ${failure.why}`)));
}

const inProcess = (p) => [`${p.rounds} rounds`, p.clock_mhz && `${wholeNumber(Math.round(p.clock_mhz[0]))} to ${wholeNumber(Math.round(p.clock_mhz[1]))} MHz`,
  p.temperature_c !== null && `at most ${threeDigits(p.temperature_c)} \u00b0C`, p.power_w && `${threeDigits(p.power_w[0])} to ${threeDigits(p.power_w[1])} W`,
  p.others_percent !== null && `others at most ${percentText(p.others_percent)} of the processors`, p.steal_percent > 0 && `${percentText(p.steal_percent)} stolen`,
  p.shared_rounds > 0 && `shared in ${p.shared_rounds}`, p.throttled_rounds > 0 && `throttled in ${p.throttled_rounds}`].filter(Boolean).join(" \u00b7 ");

function showMachines() {
  const several = page.machines.length > 1;
  const processes = page.processes.flatMap((p) => [make("dt", {}, `${several ? `Part ${p.shard}, ` : ""}Process ${p.process}`), make("dd", {}, inProcess(p))]);
  byId("errors").replaceChildren(...page.machines.flatMap((machine) => [
    make("dt", {}, page.machines.length > 1 ? `Part ${machine.shard}` : "This machine"),
    make("dd", {}, [machine.cpu, machine.clock_mhz > 0 && `${wholeNumber(Math.round(machine.clock_mhz))} MHz`, `governor ${machine.governor}`,
      `${machine.threads} threads`, `load ${machine.load_at_start} at the start, ${machine.load_at_end} at the end`,
      `OpenCL: ${machine.cl_device}, ${machine.cl_driver}`, `OpenGL: ${machine.gl_device}, ${machine.gl_driver}`,
      machine.picture === "bytes" && "timed frames end with a picture in bytes"].filter(Boolean).join(" \u00b7 "))]), ...processes);
}

function pictureFigure(number, caption) {
  const image = make("img", { src: page.pictures[number], alt: caption });
  const button = make("button", { type: "button", "aria-label": `Enlarge: ${caption}` }, image);
  button.addEventListener("click", () => {
    byId("zoom").querySelector("img").src = image.src;
    byId("zoom").showModal();
  });
  return make("figure", {}, button, make("figcaption", {}, caption));
}

const PICTURE_CAPTIONS = ["Picture", "Difference from the truth: black is equal, blue 1e-7 to red 1 of its brightest channel, white NaN",
  "HDR-FLIP, how visible the difference is: black not at all, violet little, yellow most"];

function errorTable(point) {
  const text = (value) => (value === null ? "\u2013" : errorNumber(value));
  return make("div", { class: "scrolls" }, make("table", {},
    make("thead", {}, make("tr", {}, make("td", {}, "Error"), ...ERROR_MEASURES.map(([, title]) => make("th", { scope: "col" }, title)))),
    make("tbody", {}, ...ERROR_KINDS.map(([kind, title]) => make("tr", {}, make("th", { scope: "row" }, title),
      ...ERROR_MEASURES.map(([measure]) => make("td", {}, text(measureOf(figuresOf(point.error, kind), measure))))))),
    ...(point.error.in_double ? [make("tbody", {}, make("tr", {}, make("th", { scope: "row" }, "whole picture, truth in double"),
      ...ERROR_MEASURES.map(([measure]) => make("td", {}, text(measureOf(point.error.in_double, measure))))))] : [])));
}

function sequenceTable({ frames, ...sequences }) {
  const rows = SEQUENCES.flatMap(([key, title]) => MEANS.map(([mean, words]) => [title + words, sequences[key][mean]]));
  const texts = ({ flicker, largest_flicker: largest, displayed_flip: displayed }) =>
    [threeDigits(flicker.mean), percentText(100 * flicker.visible_share), threeDigits(largest), threeDigits(displayed.mean)];
  return make("div", { class: "scrolls" }, make("table", { class: "sequences" },
    make("thead", {}, make("tr", {}, make("td", {}, `${wholeNumber(frames)} frames`),
      ...["Flicker (FLIP)", "Pixels above 0.05", "Largest step", "FLIP against the truth"].map((title) => make("th", { scope: "col" }, title)))),
    make("tbody", {}, ...rows.map(([title, figures]) => make("tr", {}, make("th", { scope: "row" }, title), ...texts(figures).map((text) => make("td", {}, text)))))));
}

// Of the chosen reference: what other views might have given.
function flipOverViews({ error }) {
  const [low, high] = error.over_views_ci95?.[state.reference]?.displayed_flip ?? [null, null];
  return low !== null && `FLIP as displayed ${errorNumber(low)} to ${errorNumber(high)} over views`;
}

const spread = (value, deviation) => `${errorNumber(value)} (standard deviation ${errorNumber(deviation)})`;

// An unbiased estimator's bias is 0; what is measured of it is the noise that is left.
function randomInWords({ total, seeds, deviation_rmse_rel: noise, bias_rmse_rel: bias }) {
  const [low, high] = seeds.bias_rmse_rel_ci95;
  const told = low > 0 ? `${errorNumber(bias)} (${errorNumber(low)} to ${errorNumber(high)})` : `not told from 0, at most ${errorNumber(high)}`;
  return `Of ${wholeNumber(seeds.pictures)} pictures with other random numbers errors are means: FLIP as displayed ${spread(total.displayed_flip.mean, seeds.deviation.displayed_flip.mean)}, `
    + `relMSE, 99.9 % ${spread(total.rel_mse_trimmed, seeds.deviation.rel_mse_trimmed)}. Relative to the brightest channel: standard deviation of a frame ${errorNumber(noise ?? 0)}, bias ${told}.`;
}

const frontOfChoice = (point) => frontOfPoint(point, state.reference, state.clock);

function choosePoint(point) {
  state.selected = point;
  const images = (point?.pictures ?? []).map((number, i) => [number, PICTURE_CAPTIONS[i]]).filter(([number]) => number >= 0);
  const error = point?.error, sampled = error?.in_double;
  const timed = point?.relative_time.runs > 0;
  const summary = point && [externalInWords(point), timed && `${intervalInWords(point.relative_time, "")} times ${page.baseline}`, timed && `${intervalInWords(point.frame_ms, " ms")} per frame`,
    point?.device_ms.runs > 0 && `on the devices ${intervalInWords(point.device_ms, " ms")}, hand-over ${threeDigits(point.hand_over_ms.median)} ms, copies ${threeDigits(point.copy_ms.median)} ms, read-back ${threeDigits(point.read_back_ms.median)} ms`,
    timed && point.frame_ms_within.p95 !== null && `95 % of frames within ${threeDigits(point.frame_ms_within.p95)} ms, 99 % within ${threeDigits(point.frame_ms_within.p99)} ms`,
    timed && modesInWords(point.relative_time), timed && point.relative_time.between_processes !== null && `${percentText(100 * point.relative_time.between_processes)} between ${point.relative_time.processes} processes`,
    `${point.views} view${point.views === 1 ? "" : "s"}`, timed && point.timed_views < point.views && `timed on ${point.timed_views} of them`, flipOverViews(point), point.pairs?.lost > 0 && `${wholeNumber(point.pairs.lost)} pairs lost`,
    quantity("leaked").value(point) !== null && `${percentText(point.leaked_percent)} of ${wholeNumber(point.pairs.shadow_pairs)} pairs leaked, ${percentText(point.acned_percent)} acned`,
    point.nan_pixels > 0 && `${wholeNumber(point.nan_pixels)} NaN pixels`,
    point.listed_per_lit !== null && `${shortNumber(point.listed_per_lit)} listed pairs for each lit one`, state.clock.relative(point).runs > 0 && onFrontInWords(state.clock.words, frontOfChoice(point).probability),
    timed && overViewsInWords(point, state.reference), timed && halfWidthInWords(point)];
  byId("chosen").replaceChildren(...(point ? [make("article", { class: "technique" }, make("h3", {}, nameElement(point.label)),
    make("p", { class: "summary quiet" }, summary.filter(Boolean).join(" \u00b7 ")),
    ...(images.length ? [make("div", { class: "pictures" }, ...images.map(([number, caption]) => pictureFigure(number, caption)))] : [make("p", { class: "quiet" }, "No pictures of this point were kept.")]),
    ...(images.length && page.reduced > 1 ? [make("p", { class: "quiet" }, `Shown at 1/${page.reduced} of their width and height so that this page stays small; those beside it are whole.`)] : []),
    errorTable(point),
    ...(sampled ? [make("p", {}, `Truth in double: at ${wholeNumber(sampled.pixels)} random pixels of opaque surfaces. There the RMSE is ${errorNumber(sampled.float_total_rmse_rel)} against the truth in float, which is within ${errorNumber(sampled.float_truth_max_rel)} of the one in double (RMSE ${errorNumber(sampled.float_truth_rmse_rel)}).`)] : []),
    ...(error.flip_views > 0 && error.flip_views < point.views ? [make("p", {}, `HDR-FLIP on ${error.flip_views} of ${point.views} views, flicker on ${error.temporal_views}.`)] : []),
    ...(error.seeds ? [make("p", {}, randomInWords(error))] : []),
    ...(error.temporal_rmse_rel !== null ? [make("p", {}, `Flicker: from frame to frame of a slow turn its difference from the truth changes by ${errorNumber(error.temporal_rmse_rel)} (RMSE over the brightest channel).`)] : []),
    ...(error.sequences ? [sequenceTable(error.sequences)] : []),
    make("details", {}, make("summary", {}, "Settings"), ...Object.entries(point.settings).map(([key, value]) => make("div", {}, make("code", {}, `${key} = ${value}`)))))] : []));
  redraw();
}

const measured = (key) => page.points.some((point) => quantity(key).value(point) !== null);
const column = (title, key) => ({ title, value: quantity(key).value, text: quantity(key).text });
const FIGURE_COLUMNS = [
  { title: "Point", value: (point) => point.label, text: (label) => pointButton(state.points.find((point) => point.label === label), nameElement(label)) },
  column("Time relative to the baseline's", "relative"), column("Frame, ms", "ms"),
  ...["relative_device", "device", "hand_over", "copy", "read_back"].filter(measured).map((key) => column(quantity(key).short ?? quantity(key).title, key)),
  ...(HAS_AUTHORED ? [column("FLIP, authored ranges", "authored.displayed_flip")] : []), column("RMSE", "total.rmse_rel"), column("Largest error", "total.max_rel"),
  column("FLIP as displayed", "total.displayed_flip"), column("relMSE, 99.9 %", "total.rel_mse_trimmed"),
  column("HDR-FLIP", "total.flip_mean"), column("Model", "model.rmse_rel"), column("Precision", "precision.rmse_rel"),
  column("Technique", "technique.rmse_rel"),
  { title: "Lost pairs", value: (point) => point.pairs?.lost ?? null, text: wholeNumber, gate: true },
  { title: "NaN pixels", value: (point) => point.nan_pixels, text: wholeNumber, gate: true },
  ...["leaked", "acned", ...SEQUENCES.map(([key]) => `${key}.plain`)].filter(measured).map((key) => column(quantity(key).title, key)),
  column("Listed pairs", "listed"), column("Bytes moved", "moved"), column("Memory", "memory"),
];

function showAmong(scene) {
  const among = page.among_opencl.filter((entry) => entry.scene === scene);
  byId("among-part").hidden = among.length < 2;
  const time = (title, key) => ({ title, value: (entry) => entry[key].estimate, text: threeDigits });
  const interval = (key) => ({ title: "95 % interval", value: (entry) => entry[key].ci95[0], text: (low) => {
    const { ci95 } = among.map((entry) => entry[key]).find((t) => t.ci95[0] === low);
    return `${threeDigits(ci95[0])} to ${threeDigits(ci95[1])}`;
  } });
  const byDevice = among.some((entry) => entry.relative_device_time.runs > 0);
  const label = (entry) => page.points[entry.point].label;
  showTable(byId("among"), [
    { title: "Point", value: label, text: (text) => pointButton(state.points.find((point) => point.label === text), nameElement(text)) },
    time("Time", "relative_time"), interval("relative_time"),
    ...(byDevice ? [time("On the devices", "relative_device_time"), interval("relative_device_time")] : []),
    { title: state.reference === "authored" ? "FLIP, authored ranges" : "FLIP as displayed", value: (entry) => frontQuantity(state.reference).value(page.points[entry.point]), text: errorNumber }], among, () => "");
}

function showTechniques() {
  const names = page.techniques.filter((name) => state.points.some((point) => point.technique === name));
  byId("techniques").replaceChildren(...names.map((name) => {
    const button = make("button", { type: "button", "aria-pressed": String(!state.hidden.has(name)) },
      make("svg", { viewBox: "-7 -7 14 14", "aria-hidden": "true" }, markerElement(name, {})), name);
    button.addEventListener("click", () => {
      if (!state.hidden.delete(name)) state.hidden.add(name);
      button.setAttribute("aria-pressed", String(!state.hidden.has(name)));
      redraw();
    });
    return make("li", {}, button);
  }));
}

function redraw() {
  if (!drawFront) return;
  const { shown, missing, floor, parted, numbered } = drawFront();
  byId("front-names").replaceChildren(...numbered.map((point) => make("li", {}, pointButton(point, nameElement(point.label)),
    ` (${state.x.text(state.x.value(point))}; ${state.y.text(state.y.value(point))})`)));
  byId("front-notes").textContent = [`${wholeNumber(shown)} points.`,
    missing > 0 && `${wholeNumber(missing)} are not shown: hidden, or without such a figure.`,
    floor !== null && `In this measure the surfaces of OpenGL and of the rasterizer in OpenCL differ by ${state.y.text(floor)}${parted ? " (dashed line): errors below it do not compare points of one kind with points of the other" : ", less than any error here"}.`].filter(Boolean).join(" ");
}

// Errors on the axes, the front and the table of what can be borne follow.
function chooseReference(reference) {
  state.reference = reference;
  for (const axis of ["x", "y"]) {
    const [kind, measure] = state[axis].key.split(".");
    const pair = [["total", "authored"], ["model", "authored_model"]].find((names) => names.includes(kind));
    if (pair) state[axis] = quantity(`${pair[reference === "authored" ? 1 : 0]}.${measure}`);
    byId(`${axis}-choice`).value = state[axis].key;
  }
  showBestWithin();
  state.points = [];
  chooseScene(state.scene);
}

function showFigures() {
  const frontTag = (point) => {
    const { on, probability } = frontOfChoice(point);
    return on ? `front${probability === null ? "" : ` ${probabilityText(probability)}`}` : "";
  };
  showTable(byId("figures-table"), FIGURE_COLUMNS, state.points, frontTag);
}

function chooseScene(key) {
  if (state.points.length > 0 && key === state.scene) return;
  state.scene = key;
  byId("scene-choice").value = key;
  const { opening, notes } = page.scenes.find((scene) => scene.key === key);
  byId("paragraph").textContent = opening.join(" ");
  byId("notes").replaceChildren(...notes.map((line) => make("li", {}, line)));
  state.points = page.points.filter((point) => point.scene === key);
  showVerdict();
  showTechniques();
  showFigures();
  showAmong(key);
  showCosts(key);
  byId("save-front").replaceChildren(saveButton(byId("front"), `front-${sceneTitle(key)}`));
  choosePoint(state.points.find((point) => frontOfChoice(point).on && point.pictures) ?? null);
}

function startChoices() {
  byId("scene-choice").replaceChildren(...page.scenes.map((scene) => make("option", { value: scene.key }, scene.title)));
  byId("scene-choice").addEventListener("change", () => chooseScene(byId("scene-choice").value));
  byId("reference-choice").closest("label").hidden = !HAS_AUTHORED;
  byId("reference-choice").addEventListener("change", () => chooseReference(byId("reference-choice").value));
  for (const axis of ["x", "y"]) {
    const select = byId(`${axis}-choice`);
    const options = (list) => list.filter((q) => page.points.some((point) => q.value(point) !== null)).map((q) => make("option", { value: q.key }, q.title));
    select.replaceChildren(make("optgroup", { label: "Cost" }, ...options(COSTS)), make("optgroup", { label: "Error" }, ...options(ERRORS)));
    select.value = state[axis].key;
    select.addEventListener("change", () => {
      state[axis] = quantity(select.value);
      if (!state.x.clock || state.x.clock === state.clock) return redraw();
      state.clock = state.x.clock;  // that fronts are of, also while the axis shows no clock's time
      showVerdict();
      showFigures();
      showCosts(state.scene);
      choosePoint(state.selected);
    });
  }
}

for (const part of ['front-part', 'table-part']) byId(part).hidden = page.points.length === 0;
showHeader();
showWarnings(page.warnings);
showBestWithin();
showFailures();
showMachines();
startChoices();
drawFront = startFront(byId("front"), state, choosePoint);
if (state.scene !== undefined) chooseScene(state.scene);
addEventListener("resize", redraw);
