// The figures of a point, and how they are written.

const ERROR_KINDS = [["total", "whole picture"], ["model", "model"], ["precision", "precision"], ["technique", "technique"]];
const ERROR_MEASURES = [["rmse_rel", "RMSE"], ["max_rel", "largest"], ["relative_rmse", "relative RMSE"], ["p99_rel", "99th percentile"],
  ["flip_mean", "FLIP, mean"]];

// Three significant digits: 0.310, 31.1, 3,107.
function threeDigits(value) {
  if (value === 0) return "0";
  const decimals = Math.min(9, Math.max(0, 2 - Number(value.toExponential(2).split("e")[1])));
  return value.toLocaleString("en-US", { minimumFractionDigits: decimals, maximumFractionDigits: decimals });
}

// Below six runs there is no interval: the range of the runs, with their number.
const intervalInWords = ({ median, low, high, runs }, unit) =>
  `${threeDigits(median)}${unit} (${threeDigits(low)} to ${threeDigits(high)}${runs < 6 ? `, ${runs} run${runs === 1 ? "" : "s"}` : ""})`;

// What an axis can show: value(point) is a number, or null where the point has none.
const errorQuantity = ([kind, kindTitle], [measure, title]) => ({ key: `${kind}.${measure}`, title: `${title}, ${kindTitle}`, short: title,
  value: (point) => point.errors[kind][measure], text: errorNumber });
const ERRORS = [...ERROR_KINDS.flatMap((kind) => ERROR_MEASURES.map((measure) => errorQuantity(kind, measure))),
  { key: "temporal", title: "Flicker, RMSE of the change", short: "Flicker", value: (point) => point.temporal, text: errorNumber }];
const COSTS = [
  { key: "ratio", title: "Time, over the baseline's", value: (point) => point.ratio?.median ?? null, text: threeDigits, time: true },
  { key: "ms", title: "Time, ms a frame", value: (point) => point.ms?.median ?? null, text: threeDigits, time: true },
  { key: "moved", title: "Bytes moved a frame", value: (point) => point.moved, text: byteNumber },
  { key: "listed", title: "Listed pairs a view", value: (point) => point.listed, text: shortCount },
  { key: "memory", title: "Memory", value: (point) => point.memory, text: byteNumber },
];
const QUANTITIES = [...COSTS, ...ERRORS];
const quantity = (key) => QUANTITIES.find((q) => q.key === key);
const TOTAL = quantity("total.rmse_rel");

const styleOf = (technique) => page.styles.find((style) => style.technique === technique);

// Points whose time does not differ from this one's and whose error is no larger: it is not ranked before or after them.
const tiedNoWorse = (point) => point.tied.map((index) => page.points[index])
  .filter((other) => other.nan === 0 && TOTAL.value(other) !== null && TOTAL.value(other) <= TOTAL.value(point));

// True for points that no other beats or equals in both while beating it in one.
function frontOf(points, x, y) {
  const places = points.map((point) => (point.nan > 0 ? [null, null] : [x.value(point), y.value(point)]));
  const better = ([ax, ay], [bx, by]) => ax <= bx && ay <= by && (ax < bx || ay < by);
  const whole = places.filter(([px, py]) => px !== null && py !== null);
  return places.map((place) => place[0] !== null && place[1] !== null && !whole.some((other) => better(other, place)));
}

function markerElement(technique, attributes) {
  const { colour, marker } = styleOf(technique);
  return make("path", { d: marker, fill: colour, stroke: colour, ...attributes });
}
