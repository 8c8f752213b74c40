// The figures of a point, and how they are written.

const page = JSON.parse(byId("page").textContent);
const HAS_AUTHORED = page.points.some((point) => point.error.authored) ||
    page.equal_flip.some((curve) => curve.of === 'authored');
const ERROR_KINDS = [["total", "whole picture"], ["model", "model"],
  ...(HAS_AUTHORED ? [["authored", "whole picture, authored ranges"], ["authored_model", "model, authored ranges"]] : []),
  ["precision", "precision"], ["technique", "technique"]];
const figuresOf = (error, kind) => (kind === "authored" ? error.authored?.total : kind === "authored_model" ? error.authored?.model : error[kind]);
const ERROR_MEASURES = page.measures.map(({ key, title }) => [key, title]);

// Three significant digits: 0.310, 31.1, 3,107.
function threeDigits(value) {
  if (value === 0) return "0";
  const decimals = Math.min(9, Math.max(0, 2 - Number(value.toExponential(2).split("e")[1])));
  return value.toLocaleString("en-US", { minimumFractionDigits: decimals, maximumFractionDigits: decimals });
}

const percentText = (percent) => `${threeDigits(percent)} %`;

const roundsText = (runs) => `${runs} round${runs === 1 ? "" : "s"}`;

// Below six runs a median has no interval: the range of the runs, with their number. With too few of them, nothing.
const intervalInWords = ({ median, estimate, ci95: [low, high], runs }, unit) =>
  `${threeDigits(median ?? estimate)}${unit} (${low === null ? `interval not measured: ${roundsText(runs)}` : `${threeDigits(low)} to ${threeDigits(high)}${runs < 6 && median !== undefined ? `, ${runs} runs` : ""}`})`;

// A measure of an error's figures, or null.
const measureOf = (figures, measure) => (measure === "displayed_flip" ? figures?.displayed_flip?.mean : figures?.[measure]) ?? null;
const size = (value) => (value === null ? null : Math.abs(value));

// Sequences of frames, and what of them is measured: the frames, or their mean over frames.
const SEQUENCES = [["still", "still camera"], ["dolly", "dolly"], ["moving_lights", "moving lights"]];
const MEANS = [["plain", ""], ["filtered", ", mean over frames"]];

// What an axis can show: value(point) is a number, or null where the point has none.
const errorQuantity = ([kind, kindTitle], [measure, title]) => ({ key: `${kind}.${measure}`, title: `${title}, ${kindTitle}`, short: title,
  value: ({ error }) => size(measureOf(figuresOf(error, kind), measure)), text: errorNumber });
const ERRORS = [...ERROR_KINDS.flatMap((kind) => ERROR_MEASURES.map((measure) => errorQuantity(kind, measure))),
  { key: "temporal", title: "Flicker, RMSE of the change", short: "Flicker", value: ({ error }) => error.temporal_rmse_rel, text: errorNumber },
  ...SEQUENCES.flatMap(([key, title]) => MEANS.map(([mean, words]) => ({ key: `${key}.${mean}`, title: `Flicker (FLIP), ${title}${words}`, short: "Flicker (FLIP)",
    value: ({ error }) => error.sequences?.[key][mean].flicker.mean ?? null, text: threeDigits }))),
  ...["Leaked", "Acned"].map((title) => ({ key: title.toLowerCase(), title: `${title} pairs, %`, short: title,
    value: (point) => point[`${title.toLowerCase()}_percent`] ?? null, text: percentText }))];
// What wall time and the devices' time have each: the relative time, fronts and their bands, cheapest points, milliseconds.
const WALL = { relative: (point) => point.relative_time, fronts: (point) => point.fronts, bands: page.flip_front_bands, within: page.cheapest_within_flip, equalFlip: page.equal_flip, ms: (point) => point.frame_ms, words: "" };
const DEVICE = { relative: (point) => point.relative_device_time, fronts: (point) => point.device_fronts, bands: page.device_flip_front_bands, within: page.device_cheapest_within_flip, equalFlip: page.device_equal_flip, ms: (point) => point.device_ms,
  words: " by the devices' clocks" };
const COSTS = [
  { key: "relative", clock: WALL, title: "Time relative to the baseline's", value: (point) => point.relative_time.estimate, text: threeDigits, time: true },
  { key: "ms", title: "Time, ms per frame", value: (point) => point.frame_ms.median, text: threeDigits, time: true },
  { key: "p95", title: "Time that 95 % of frames are within, ms", value: (point) => point.frame_ms_within.p95, text: threeDigits, time: true },
  { key: "p99", title: "Time that 99 % of frames are within, ms", value: (point) => point.frame_ms_within.p99, text: threeDigits, time: true },
  { key: "relative_device", title: "Device time relative to the baseline's", short: "Device time, relative", value: (point) => point.relative_device_time.estimate, text: threeDigits, time: true, clock: DEVICE },
  ...[["device", "On the devices"], ["hand_over", "Hand-over"], ["copy", "Copies"], ["read_back", "Read-back"]].map(([key, title]) => (
    { key, title: `${title}, ms per frame`, short: `${title}, ms`, value: (point) => point[`${key}_ms`].median, text: threeDigits, time: true })),
  { key: "moved", title: "Bytes moved per frame", value: (point) => point.bytes_moved, text: byteNumber },
  { key: "listed", title: "Listed pairs a view", value: ({ pairs, views }) => (pairs ? pairs.listed / views : null), text: shortCount },
  { key: "memory", title: "Memory", value: (point) => point.memory_bytes, text: byteNumber },
];
const QUANTITIES = [...COSTS, ...ERRORS];
const quantity = (key) => QUANTITIES.find((q) => q.key === key);
// What fronts, their bands and probabilities are of, against one of the two references: total or authored.
const frontQuantity = (reference) => quantity(`${reference}.displayed_flip`);
const frontOfPoint = (point, reference, clock) => clock.fronts(point)?.[reference] ?? { on: false, probability: 0 };

// By how much the truths on the surfaces of the two rasterizers differ, if `y` is a measure of the total; null: not measured, or nothing.
function surfacesFloor(points, { key }) {
  const [kind, measure] = key.split(".");
  return kind === "total" ? points.map(({ error }) => size(measureOf(error.surfaces, measure))).find((floor) => floor > 0) ?? null : null;
}

// Null: too few rounds, or a control that failed.
const probabilityText = (p) => (p === null ? "not measured" : p > 0.995 ? "more than 99 %" : p < 0.005 ? "less than 1 %" : `${Math.round(100 * p)} %`);
const onFrontInWords = (clock, p, on = "on") => (p === null ? `probability of being on the front${clock}: not measured`
  : `${on} the front${clock} with a probability of ${probabilityText(p)}`);

// For other views of the scene, by the clock that decides there; null: not measured.
const CLOCK_WORDS = { wall: "wall-clock time", cpu: "processor time", device: "device time" };
const frontOverViews = (point, reference) => point.p_front_views?.[reference] ?? null;
const overViewsInWords = (point, reference) => { const p = frontOverViews(point, reference);
  return p === null ? "probability of being on the front of other views: not measured" : `on the front of other views with a probability of ${probabilityText(p)} (${CLOCK_WORDS[point.clock]})`; };
const halfWidthInWords = (point) => (point.half_width === null || point.reached ? "" : `half-width ${percentText(100 * point.half_width)} (${CLOCK_WORDS[point.clock]}), more than the ${percentText(100 * page.half_width)} to reach`);

// Runs that fall into two groups: "two modes: 0.9 and 1.8 (30 % of runs)".
const modesInWords = ({ modes, slow_share: share }) => (modes.length ? `two modes: ${threeDigits(modes[0])} and ${threeDigits(modes[1])} (${Math.round(100 * share)} % of runs)` : "");

// True for points that no other beats or equals in both while beating it in one. On the default axes, with no technique hidden,
// these are the points on the front in frontier.json.
function frontOf(points, x, y) {
  const places = points.map((point) => (point.nan_pixels > 0 ? [null, null] : [x.value(point), y.value(point)]));
  const better = ([ax, ay], [bx, by]) => ax <= bx && ay <= by && (ax < bx || ay < by);
  const whole = places.filter(([px, py]) => px !== null && py !== null);
  return places.map((place) => place[0] !== null && place[1] !== null && !whole.some((other) => better(other, place)));
}

// Color by technique, shape by family; a label names its technique before the colon.
const MARKERS = {
  deferred: "M-4.5,-4.5h9v9h-9z",
  clustered: "M0,-5.5L5.2,4.2H-5.2z",
  lidr: "M0,-6L6,0L0,6L-6,0z",
  world: "M-6,-2.5h12v5h-12z",
  voxel: "M-5,-3L0,-6L5,-3V3L0,6L-5,3z",
  visibility: "M-2,-5.5h4v3.5h3.5v4h-3.5v3.5h-4v-3.5h-3.5v-4h3.5z",
};
const STAR = "M0,-6.5L1.7,-2.2L6.2,-2L2.7,0.9L3.9,5.3L0,2.8L-3.9,5.3L-2.7,0.9L-6.2,-2L-1.7,-2.2z";
const EXTERNAL = new Set(page.points.filter((point) => point.external).map((point) => point.technique));  // other renderers
const CIRCLE = "M-5,0a5,5 0 1,0 10,0a5,5 0 1,0 -10,0z";
const techniqueOf = (label) => label.split(":")[0];
const techniqueColor = (technique) => colorNumber(page.techniques.indexOf(technique));

function markerElement(technique, attributes) {
  const color = techniqueColor(technique);
  return make("path", { d: EXTERNAL.has(technique) ? STAR : MARKERS[technique.split("_")[0]] ?? CIRCLE, fill: color, stroke: color, ...attributes });
}

// Of a point of another renderer.
const externalInWords = ({ external }) => external && `another renderer${external.note ? ` (${external.note})` : ""}, ${external.paired ? "timed by itself in the rounds" : "timed elsewhere, not in these rounds"}`;

const moveTo = (x, y) => ({ transform: `translate(${x.toFixed(1)} ${y.toFixed(1)})` });

// Marks with names, `across` of them beside each other.
const markedNames = (names, left, top, across, width) => names.flatMap(({ technique, text }, i) => {
  const x = left + (i % across) * width / across, y = top + 20 * Math.floor(i / across);
  return [markerElement(technique, moveTo(x + 6, y)), make("text", { x: x + 20, y: y + 4 }, text)];
});
