// Stacked bars of the time per pass, one a technique, in inline SVG.

const PASS_COLOURS = ["#3b6fb6", "#d9822b", "#3f9b58", "#b5475d", "#7d5bb0", "#2a9aa0", "#a5762c", "#c25aa0", "#6b8e23", "#4e5fa8"];
const REST = "the rest of the frame";
const REST_COLOUR = "#8a857c";

// [{ name, ms }]: the passes in order, then what the frame's median holds beyond them.
function timeParts(row) {
  const parts = row.passes.map((pass) => ({ name: pass.name, on: pass.on, ms: pass.median_ms ?? 0 }));
  const rest = (row.frame_ms.median ?? 0) - parts.reduce((sum, part) => sum + part.ms, 0);
  if (rest > 0) parts.push({ name: REST, on: "", ms: rest });
  return parts;
}

function showTimeBars(rows, names) {
  const passes = [...new Set(rows.flatMap((row) => row.passes.map((pass) => pass.name)))];
  const colourOf = (name) => (name === REST ? REST_COLOUR : PASS_COLOURS[passes.indexOf(name) % PASS_COLOURS.length]);
  const bars = rows.map((row, i) => {
    const parts = timeParts(row);
    return { name: names[i], row, parts, total: parts.reduce((sum, part) => sum + part.ms, 0) };
  });
  const longest = Math.max(...bars.map((bar) => bar.total));

  const legend = [...passes, ...(bars.some((bar) => bar.parts.some((part) => part.name === REST)) ? [REST] : [])];
  byId("pass-legend").replaceChildren(
    ...legend.map((name) => make("li", {}, make("i", { style: `background:${colourOf(name)}` }), name)));

  const drawBar = (bar, scale, width) => {
    const svg = make("svg", { role: "img", "aria-label": `${bar.name}: ${bar.parts.map((p) => `${p.name} ${milliseconds(p.ms)}`).join(", ")}` },
      make("rect", { class: "track", width: "100%", height: "100%", rx: 3 }));
    let start = 0;
    for (const part of bar.parts) {
      const share = scale > 0 ? part.ms / scale : 0;
      const label = `${part.name}${part.on ? ` (${part.on})` : ""}: ${milliseconds(part.ms)}`;
      const x = `${100 * start}%`;
      svg.append(make("rect", { x, width: `${100 * share}%`, height: "100%", fill: colourOf(part.name) }, make("title", {}, label)));
      // About 7 px a character: the longest of name and time, time, or nothing that fits.
      const fitting = [`${part.name} ${milliseconds(part.ms)}`, milliseconds(part.ms)].find((text) => text.length * 7 + 12 < share * width);
      if (fitting) svg.append(make("text", { x, y: "50%", dx: 6, dy: "0.35em", "pointer-events": "none" }, fitting));
      start += share;
    }
    return svg;
  };

  const draw = () => {
    const width = byId("time-bars").clientWidth;
    const ownScale = byId("own-scale").checked;
    byId("time-bars").replaceChildren(...bars.map((bar) => {
      const spread = `${milliseconds(bar.row.frame_ms.median ?? 0)} (${shortNumber(bar.row.frame_ms.min ?? 0)} to ${shortNumber(bar.row.frame_ms.max ?? 0)}, ${bar.row.frame_ms.runs} runs)`;
      return make("div", { class: "bar" },
        make("p", {}, make("strong", {}, bar.name), make("span", { class: "quiet" }, spread)),
        drawBar(bar, ownScale ? bar.total : longest, width));
    }));
  };
  byId("own-scale").addEventListener("change", draw);
  addEventListener("resize", draw);
  draw();
}
