// Elements and number formats for the other scripts.

const byId = (id) => document.getElementById(id);

// make("p", { class: "quiet" }, "text", node, ...)
function make(tag, attributes, ...children) {
  const svg = ["svg", "g", "rect", "line", "polyline", "circle", "path", "text", "title"].includes(tag);
  const element = svg ? document.createElementNS("http://www.w3.org/2000/svg", tag) : document.createElement(tag);
  for (const [name, value] of Object.entries(attributes ?? {})) element.setAttribute(name, value);
  element.append(...children);
  return element;
}

// Warnings, with the command that avoids each; [{ text, command }].
function showWarnings(warnings) {
  const list = byId("warnings"), lines = [...new Map(warnings.map((warning) => [warning.text, warning])).values()];
  list.hidden = lines.length === 0;
  list.replaceChildren(...lines.map(({ text, command }) => {
    if (command === null) return make("li", {}, text);
    const copy = make("button", { type: "button", class: "copy" }, "Copy");
    copy.addEventListener("click", () => navigator.clipboard.writeText(command));
    return make("li", {}, text, make("div", {}, make("code", {}, command), " ", copy));
  }));
}

// A row's name, with line breaks only after colons and commas.
function nameElement(name) {
  const parts = name.split(/(?<=[:,])/);
  return make("span", {}, ...parts.flatMap((part, i) => (i ? [make("wbr"), part] : [part])));
}

// Three significant digits: 2,420  214  11.3  0.59
function shortNumber(value) {
  const digits = value >= 100 ? 0 : value >= 10 ? 1 : 2;
  return value.toLocaleString("en-US", { minimumFractionDigits: digits, maximumFractionDigits: digits });
}

const wholeNumber = (value) => value.toLocaleString("en-US");
const lightsNumber = (value) => (value >= 100 ? shortNumber(value) : value.toFixed(1));
// 3.69 M: there can be hundreds of millions of pairs.
function shortCount(value) {
  if (value < 10000) return wholeNumber(value);
  const [divisor, unit] = value < 1e6 ? [1e3, "k"] : value < 1e9 ? [1e6, "M"] : [1e9, "G"];
  return `${shortNumber(value / divisor)} ${unit}`;
}

const milliseconds = (value) => `${shortNumber(value)} ms`;
const errorNumber = (value) => (value === 0 ? "0" : value.toExponential(1).replace("+", ""));

function byteNumber(value) {
  for (const unit of ["B", "KiB", "MiB"]) {
    if (value < 1024) return `${unit === "B" ? value : shortNumber(value)} ${unit}`;
    value /= 1024;
  }
  return `${shortNumber(value)} GiB`;
}

// The error of one comparison in words; JSON has null for figures that are not finite.
function errorInWords(error) {
  if (error.bit_identical) return "bit-identical";
  if (error.max_rel === null) return "not finite: a NaN, or a black reference";
  return `RMSE ${errorNumber(error.rmse_rel)}, at most ${errorNumber(error.max_rel)}`;
}

// Both images compared with the oracle, at the same pixels.
function oracleInWords(oracle, reference) {
  if (!oracle || oracle.max_rel === null || oracle.of_reference_max_rel === null) return "";
  return `; differs from the oracle by at most ${errorNumber(oracle.max_rel)}, ${reference} by ${errorNumber(oracle.of_reference_max_rel)}`;
}

// Against light and surfaces both in double.
function surfacesInWords({ sum_rel, rmse_rel }) {
  if (sum_rel === null || rmse_rel === null) return "not finite";
  const sum = `${errorNumber(100 * Math.abs(sum_rel))} % ${sum_rel < 0 ? "darker" : "brighter"}`;
  return `RMSE ${errorNumber(rmse_rel)}, in sum ${sum_rel === 0 ? "equal" : sum}`;
}

// Says what differs beside the silhouettes of a technique with a rasteriser of its own.
function silhouettesInWords({silhouettes, inside}) {
  if (!silhouettes || inside.max_rel === null) return '';
  return `; ${wholeNumber(silhouettes.pixels)} pixels show another triangle, elsewhere RMSE ${
      errorNumber(inside.rmse_rel)}, at most ${errorNumber(inside.max_rel)}`;
}

// Twenty colors that are distinguishable on light and dark paper; the first ten best.
const COLORS = ["#3b6fb6", "#d9822b", "#3f9b58", "#b5475d", "#7d5bb0", "#2a9aa0", "#a5762c", "#c25aa0", "#6b8e23", "#4e5fa8",
  "#8c564b", "#17a2d4", "#c7a008", "#e2664f", "#5aa17f", "#9467bd", "#7f8f2e", "#d66fa8", "#5b7f95", "#b07d62"];
const colorNumber = (number) => COLORS[number % COLORS.length];
