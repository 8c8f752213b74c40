// What the plots of the pages share: logarithmic axes in inline SVG, and the .svg file of a plot.

// Position of a value between low and high, on a logarithmic axis from `from` to `to` in pixels.
const onAxis = (value, low, high, from, to) =>
  from + (high > low ? Math.log(value / low) / Math.log(high / low) : 0.5) * (to - from);

// `digits` times each power of ten, from the one at or below `low` to the one at or above `high`.
function decadeSteps(low, high, digits) {
  const steps = [];
  for (let decade = Math.floor(Math.log10(low)); decade <= Math.ceil(Math.log10(high)); ++decade) {
    for (const digit of digits) steps.push({ value: Number(`${digit}e${decade}`), decade });
  }
  return steps;
}

function tickText(value) {
  if (value >= 1e6) return shortCount(value);
  return value === 0 ? "0" : value >= 0.0099 ? String(Number(value.toPrecision(6))) : value.toExponential(0);
}

const ZERO_ROOM = 34;  // pixels between the place of 0 and the axis

// From `from` to `to` in pixels. 0 has a place of its own before the axis's begin.
function logAxis(values, from, to) {
  const positive = values.filter((value) => value > 0 && Number.isFinite(value)), hasZero = values.includes(0);
  const low = (positive.length ? Math.min(...positive) : 1) / 1.3, high = (positive.length ? Math.max(...positive) : 1) * 1.3;
  const begin = hasZero ? from + Math.sign(to - from) * ZERO_ROOM : from;
  const decades = Math.log10(high / low), every = Math.ceil(decades / (Math.abs(to - from) / 45));  // a label takes 45 pixels
  const ticks = decadeSteps(low, high, decades < 2 ? [1, 2, 5] : [1])
    .filter(({ value, decade }) => value >= low && value <= high && decade % every === 0).map(({ value }) => value);
  return { ticks: hasZero ? [0, ...ticks] : ticks, at: (value) => (value === 0 ? from : onAxis(value, low, high, begin, to)) };
}

// Rules and labels of an axis along the lower or the left side of an area; title: of the axis.
function acrossAxis(axis, title, { left, right, top, bottom }) {
  return [...axis.ticks.flatMap((value) => [
    make("line", { class: value === 0 ? "rule zero" : "rule", x1: axis.at(value), x2: axis.at(value), y1: top, y2: bottom }),
    make("text", { x: axis.at(value), y: bottom + 18, "text-anchor": "middle" }, tickText(value))]),
  make("text", { x: (left + right) / 2, y: bottom + 42, "text-anchor": "middle" }, title)];
}

function alongAxis(axis, title, { left, right, top }) {
  return [...axis.ticks.flatMap((value) => [
    make("line", { class: value === 0 ? "rule zero" : "rule", x1: left, x2: right, y1: axis.at(value), y2: axis.at(value) }),
    make("text", { x: left - 8, y: axis.at(value), dy: "0.32em", "text-anchor": "end" }, tickText(value))]),
  make("text", { x: 8, y: top - 18 }, title)];
}

const polyline = (places, attributes) =>
  make("polyline", { fill: "none", points: places.map((at) => at.map((value) => value.toFixed(1)).join(",")).join(" "), ...attributes });

const drawing = (width, height, title, ...parts) =>
  make("svg", { class: "chart", viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": title }, ...parts);

// The text of a plot's file, in the colors that it has now. It shows parts that the page hides (class only-file) in a box of
// data-file-height, and has a <title> for each data-title.
function svgText(svg) {
  const copy = svg.cloneNode(true), copies = copy.querySelectorAll("*");
  svg.querySelectorAll("*").forEach((element, i) => {
    const style = getComputedStyle(element);
    for (const name of ["fill", "fill-opacity", "stroke", "stroke-width", "stroke-dasharray", "opacity", "font-size"])
      copies[i].style.setProperty(name, style.getPropertyValue(name));
    if (element.dataset.title) copies[i].append(make("title", {}, element.dataset.title));
  });
  const [, , width, height] = svg.getAttribute("viewBox").split(" ");
  copy.setAttribute("viewBox", `0 0 ${width} ${svg.dataset.fileHeight ?? height}`);
  copy.setAttribute("style", `font-family: sans-serif; background: ${getComputedStyle(document.body).backgroundColor}`);
  copy.prepend(make("title", {}, svg.getAttribute("aria-label")));
  return new XMLSerializer().serializeToString(copy);
}

// A button that saves the plot in `container` as NAME.svg.
function saveButton(container, name) {
  const button = make("button", { type: "button", class: "link save" }, "Save as SVG");
  button.addEventListener("click", () => {
    const url = URL.createObjectURL(new Blob([svgText(container.querySelector("svg"))], { type: "image/svg+xml" }));
    make("a", { href: url, download: `${name.replace(/[^\w.=+-]+/g, "-")}.svg` }).click();
    setTimeout(() => URL.revokeObjectURL(url));
  });
  return button;
}
