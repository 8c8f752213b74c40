// Making elements and writing numbers: what the other scripts share.

const byId = (id) => document.getElementById(id);

// make("p", { class: "quiet" }, "text", node, ...)
function make(tag, attributes, ...children) {
  const svg = ["svg", "rect", "text", "title"].includes(tag);
  const element = svg ? document.createElementNS("http://www.w3.org/2000/svg", tag) : document.createElement(tag);
  for (const [name, value] of Object.entries(attributes ?? {})) element.setAttribute(name, value);
  element.append(...children);
  return element;
}

// Three digits that count: 2,420  214  11.3  0.59
function shortNumber(value) {
  const digits = value >= 100 ? 0 : value >= 10 ? 1 : 2;
  return value.toLocaleString("en-US", { minimumFractionDigits: digits, maximumFractionDigits: digits });
}

const wholeNumber = (value) => value.toLocaleString("en-US");
const lightsNumber = (value) => (value >= 100 ? shortNumber(value) : value.toFixed(1));
const milliseconds = (value) => `${shortNumber(value)} ms`;
const errorNumber = (value) => (value === 0 ? "0" : value.toExponential(1));

function byteNumber(value) {
  for (const unit of ["B", "KiB", "MiB"]) {
    if (value < 1024) return `${unit === "B" ? value : shortNumber(value)} ${unit}`;
    value /= 1024;
  }
  return `${shortNumber(value)} GiB`;
}

// The error of one comparison in words; JSON holds null where a figure is not finite.
function errorInWords(error) {
  if (error.bit_identical) return "bit-identical";
  if (error.max_rel === null) return "not finite: a NaN, or a black reference";
  return `at most ${errorNumber(error.max_abs)}, which is ${errorNumber(error.max_rel)} of the brightest channel; RMSE ${errorNumber(error.rmse)}`;
}
