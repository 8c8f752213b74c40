// Frame time as curves, on logarithmic axes, in inline SVG. Everything is computed beforehand; this only draws.

const CHART_HEIGHT = 340;
const CHART_MARGIN = { left: 56, right: 16, top: 26, bottom: 44 };

// One color per name, the same in every chart of the page.
const curveNames = [];
function curveColor(name) {
  if (!curveNames.includes(name)) curveNames.push(name);
  return colorNumber(curveNames.indexOf(name));
}
const curveDash = (curve) => (curve.flat ? "2 4" : curveNames.indexOf(curve.name) >= COLORS.length ? "7 3" : "none");

// 1, 2, 5, 10, … from below `low` to above `high`.
function roundSteps(low, high) {
  const steps = decadeSteps(low, high, [1, 2, 5]).map(({ value }) => value);
  const first = steps.findLastIndex((step) => step <= low), last = steps.findIndex((step) => step >= high);
  return steps.slice(Math.max(first, 0), last + 1);
}

function chartFrame(chart, width, x, y, steps) {
  const { left, right, top, bottom } = CHART_MARGIN;
  const frame = [];
  for (const step of steps) {
    frame.push(make("line", { class: "rule", x1: left, x2: width - right, y1: y(step), y2: y(step) }),
      make("text", { x: left - 6, y: y(step), dy: "0.32em", "text-anchor": "end" }, shortNumber(step).replace(/\.0+$|(\.\d)0$/, "$1")));
  }
  let free = -Infinity;  // labels that would overlap the previous one are omitted
  for (const tick of chart.ticks) {
    const half = tick.label.length * 3.6;
    frame.push(make("line", { class: "rule", x1: x(tick.x), x2: x(tick.x), y1: top, y2: CHART_HEIGHT - bottom }));
    if (x(tick.x) - half < free) continue;
    frame.push(make("text", { x: x(tick.x), y: CHART_HEIGHT - bottom + 16, "text-anchor": "middle" }, tick.label));
    free = x(tick.x) + half + 6;
  }
  frame.push(make("text", { x: (left + width - right) / 2, y: CHART_HEIGHT - 8, "text-anchor": "middle" }, [chart.axis, chart.kept].filter(Boolean).join(", ")),
    make("text", { x: left - 6, y: 11, "text-anchor": "end" }, "ms"));
  return frame;
}

function drawCurve(chart, curve, x, y) {
  const color = curveColor(curve.name);
  const points = curve.points.map((p) => `${x(p.x).toFixed(1)},${y(p.ms).toFixed(1)}`).join(" ");
  const labelOf = (p) => chart.ticks.find((tick) => tick.x === p.x)?.label ?? wholeNumber(p.x);
  const dots = curve.flat ? [] : curve.points.map((p) =>
    make("circle", { cx: x(p.x).toFixed(1), cy: y(p.ms).toFixed(1), r: 4, fill: p.exact ? color : "var(--card)", stroke: color,
      "stroke-width": 2, "data-view": p.view, "data-row": p.row },
      make("title", {}, `${curve.name}, ${labelOf(p)} ${chart.axis}: ${milliseconds(p.ms)}${p.exact ? "" : ", not exact"}`)));
  return make("g", { class: "curve", "data-name": curve.name },
    make("polyline", { points, fill: "none", stroke: color, "stroke-width": 2, "stroke-dasharray": curveDash(curve) },
      make("title", {}, curve.name)), ...dots);
}

function drawChart(chart, width) {
  const { left, right, top, bottom } = CHART_MARGIN;
  const times = chart.curves.flatMap((curve) => curve.points.map((p) => p.ms)).filter((ms) => ms > 0);
  const steps = roundSteps(Math.min(...times), Math.max(...times));
  const xs = chart.ticks.map((tick) => tick.x);
  const x = (value) => onAxis(value, xs[0], xs[xs.length - 1], left + 14, width - right - 14);
  const y = (ms) => onAxis(ms, steps[0], steps[steps.length - 1], CHART_HEIGHT - bottom, top);
  const marks = chart.crossings.filter((crossing) => crossing.lead).map((crossing) =>
    make("circle", { class: "crossing", cx: x(crossing.x), cy: y(crossing.ms), r: 8 },
      make("title", {}, `${crossing.below} and ${crossing.above} cross at about ${shortNumber(crossing.x)} ${chart.axis}`)));
  return drawing(width, CHART_HEIGHT, `Frame time over ${chart.axis}: ${chart.title}`, ...chartFrame(chart, width, x, y, steps), ...chart.curves.map((curve) => drawCurve(chart, curve, x, y)), ...marks);
}

function crossingTable(chart) {
  const rows = chart.crossings.map((c) => make("tr", {}, make("td", {}, c.below), make("td", {}, shortNumber(c.x)),
    make("td", {}, c.above), make("td", {}, milliseconds(c.ms))));
  const head = ["Faster below", `Cross at, ${chart.axis}`, "Faster above", "There"].map((title) => make("th", { scope: "col" }, title));
  return make("details", {}, make("summary", {}, `All crossings (${rows.length})`),
    make("div", { class: "scrolls" }, make("table", {}, make("thead", {}, make("tr", {}, ...head)), make("tbody", {}, ...rows))));
}

// In the order in which the curves end on the right, from the top. A click on a name hides or shows its curve.
function chartLegend(chart, plot) {
  const lastMs = (curve) => curve.points[curve.points.length - 1].ms;
  const fromTheTop = [...chart.curves].sort((a, b) => lastMs(b) - lastMs(a));
  return make("ul", { class: "curve-names" }, ...fromTheTop.map((curve) => {
    const button = make("button", { type: "button", "aria-pressed": "true" },
      make("i", { style: `background:${curveColor(curve.name)}` }), curve.name);
    button.addEventListener("click", () => {
      const shown = button.getAttribute("aria-pressed") !== "true";
      button.setAttribute("aria-pressed", shown);
      plot.querySelector(`[data-name="${CSS.escape(curve.name)}"]`).style.display = shown ? "" : "none";
    });
    return make("li", {}, button);
  }));
}

function showCharts(container, charts) {
  const figures = charts.map((chart) => {
    const plot = make("div", { class: "plot" });
    return { chart, plot, element: make("figure", { class: "chart-card" },
      make("figcaption", {}, make("strong", {}, chart.title), ` \u2013 frame time over ${chart.axis}`), plot,
      chartLegend(chart, plot), ...chart.sentences.map((line) => make("p", {}, line)),
      ...(chart.crossings.length > 0 ? [crossingTable(chart)] : [])) };
  });
  container.replaceChildren(...figures.map(({ element }) => element));
  const draw = () => {
    for (const { chart, plot } of figures) {
      const hidden = [...plot.querySelectorAll(".curve")].filter((g) => g.style.display === "none").map((g) => g.dataset.name);
      plot.replaceChildren(drawChart(chart, Math.max(280, plot.clientWidth)));
      for (const g of plot.querySelectorAll(".curve")) if (hidden.includes(g.dataset.name)) g.style.display = "none";
    }
  };
  draw();
  return draw;
}
