// Stacked bars in inline SVG: time per pass, and memory.

const REST_COLOR = "#8a857c";

// What a pass does, by its name: one color for all techniques. The first that fits counts.
const STAGES = [
  { name: "copies between APIs", color: "#8c6a4f", passes: /_to_(cl|gl)$|^read_back$/ },
  { name: "blended surfaces", color: "#c25aa0", passes: /blend/ },
  { name: "depth bounds", color: "#7d5bb0", passes: /^depth_bounds$|^tile_distances$/ },
  { name: "geometry buffer", color: "#2a9aa0", passes: /gbuffer|geometry_buffer|normals/ },
  { name: "triangles and depth", color: "#3b6fb6", passes: /^depth_prepass$|^rasterize$/ },
  { name: "light and materials", color: "#d9822b", passes: /^shade|^resolve|light_buffer|materials/ },
  { name: "lists of lights", color: "#3f9b58", passes: /cull|light|grid|voxels|cap_lists|lists_of_tree/ },
];
const stageOf = (pass) => STAGES.find((stage) => stage.passes.test(pass)) ?? { name: "other", color: REST_COLOR };

function drawBar(bar, scale, width, colorOf, text) {
  const svg = make("svg", { role: "img", "aria-label": `${bar.name}: ${bar.parts.map((p) => `${p.name} ${text(p.value)}`).join(", ")}` },
    make("rect", { class: "track", width: "100%", height: "100%", rx: 3 }));
  let start = 0;
  for (const part of bar.parts) {
    const share = scale > 0 ? part.value / scale : 0;
    const x = `${100 * start}%`;
    svg.append(make("rect", { x, width: `${100 * share}%`, height: "100%", fill: colorOf(part.name) },
      make("title", {}, `${part.name}${part.on ? ` (${part.on})` : ""}: ${text(part.value)}`)));
    // About 7 px a character: name and value, value, or nothing, whichever is the longest that fits.
    const fitting = [`${part.name} ${text(part.value)}`, text(part.value)].find((t) => t.length * 7 + 12 < share * width);
    if (fitting) svg.append(make("text", { x, y: "50%", dx: 6, dy: "0.35em", "pointer-events": "none" }, fitting));
    start += share;
  }
  return svg;
}

// bars: [{ name, note, parts: [{ name, on, value }] }]. The part named `rest` is gray; groupOf(name): what the legend names,
// { name, color }. ownScale: a checkbox, or null. Returns a function that redraws them.
function showBars(container, legend, bars, rest, groupOf, text, ownScale) {
  const partNames = [...new Set(bars.flatMap((bar) => bar.parts.map((part) => part.name)))].filter((name) => name !== rest);
  const groups = new Map(partNames.map((name) => groupOf(name, partNames)).map((group) => [group.name, group.color]));
  const colorOf = (name) => (name === rest ? REST_COLOR : groupOf(name, partNames).color);
  const total = (bar) => bar.parts.reduce((sum, part) => sum + part.value, 0);
  const longest = Math.max(...bars.map(total), 0);
  const hasRest = bars.some((bar) => bar.parts.some((part) => part.name === rest));
  legend.replaceChildren(...[...groups, ...(hasRest ? [[rest, REST_COLOR]] : [])].map(([name, color]) =>
    make("li", {}, make("i", { style: `background:${color}` }), name)));
  const draw = () => {
    const width = container.clientWidth;
    container.replaceChildren(...bars.map((bar) =>
      make("div", { class: "bar" },
        make("p", {}, make("strong", {}, bar.name), make("span", { class: "quiet" }, bar.note)),
        drawBar(bar, ownScale?.checked ? total(bar) : longest, width, colorOf, text))));
  };
  draw();
  return draw;
}

// The passes in order, then the rest of the frame's median.
function timeBar(name, row) {
  const parts = row.passes.map((pass) => ({ name: pass.name, on: pass.on, value: pass.median_ms ?? 0 }));
  const rest = (row.frame_ms.median ?? 0) - parts.reduce((sum, part) => sum + part.value, 0);
  if (rest > 0) parts.push({ name: "the rest of the frame", value: rest });
  const note = `${milliseconds(row.frame_ms.median ?? 0)} (${row.frame_ms.runs > 1 ? `${shortNumber(row.frame_ms.min ?? 0)} to ${shortNumber(row.frame_ms.max ?? 0)}, ${row.frame_ms.runs} frames` : "one frame"})`;
  return { name, note, parts };
}

function memoryBar(name, row) {
  const { total, light_grid, gbuffer } = row.memory_bytes;
  const parts = [{ name: "light grid", value: light_grid }, { name: "G-buffer", value: gbuffer },
    { name: "scene, images, lights", value: Math.max(0, total - light_grid - gbuffer) }];
  return { name, note: byteNumber(total), parts: parts.filter((part) => part.value > 0) };
}
