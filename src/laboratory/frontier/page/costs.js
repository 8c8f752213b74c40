// The shading costs from which tighter cull tests win, and how time grows, as plots of one scene.

const PLOT_WIDTH = 560;

// "exact over sphere, tile=8": labels that differ in the cull test, in short.
function pairInWords({ scene, tighter, looser }) {
  const testOf = (label) => page.points.find((point) => point.scene === scene && point.label === label)?.settings.cull_test ?? label;
  const others = tighter.split(/[:,]/).slice(1).filter((item) => !/^cull[-_]test=/.test(item));
  return [`${testOf(tighter)} over ${testOf(looser)}`, ...others].join(", ");
}

// The bar begins where the tighter test begins to win; the thin line through its end is the interval of that place.
function pairBar(pair, x, y, right) {
  const { ns_per_pixel_light: cost, ci95: [low, high], rounds } = pair, words = pairInWords(pair);
  const wins = cost === null ? "never" : cost === 0 ? "always" : `from ${threeDigits(cost)} ns`;
  const interval = rounds > 0 ? ` (${threeDigits(low)} to ${threeDigits(high)})` : "";
  const parts = [make("text", { x: x.at(0), y: y + 14 }, `${words}: ${wins}${interval}`)];
  if (cost === null) return parts;
  parts.push(make("rect", { class: "wins", x: x.at(cost), y: y + 19, width: right - x.at(cost), height: 9, rx: 2 }, make("title", {},
    `${words}: ${wins}${interval}. Culling takes ${threeDigits(pair.extra_ms)} ms more a view and lists ${threeDigits(pair.pairs_saved)} fewer pairs`)));
  if (rounds === 0) return parts;
  parts.push(make("line", { class: "interval", x1: x.at(low), x2: x.at(high), y1: y + 23.5, y2: y + 23.5 }));
  for (const end of [low, high]) parts.push(make("line", { class: "interval", x1: x.at(end), x2: x.at(end), y1: y + 19, y2: y + 28 }));
  return parts;
}

function breakEvenPlot(scene, technique) {
  const cheapest = (a, b) => (a.ns_per_pixel_light ?? Infinity) - (b.ns_per_pixel_light ?? Infinity) || 0;
  const pairs = page.break_even.filter((pair) => pair.scene === scene && techniqueOf(pair.tighter) === technique).sort(cheapest);
  const costs = page.shading_costs.filter((cost) => cost.scene === scene && cost.technique === technique).sort(cheapest);
  if (pairs.length === 0) return null;
  const top = 14 + 16 * costs.length, area = { left: 16, right: PLOT_WIDTH - 16, top, bottom: top + 34 * pairs.length };
  const x = logAxis([0, ...[...pairs, ...costs].map((cost) => cost.ns_per_pixel_light ?? 0), ...pairs.flatMap((pair) => pair.ci95.map((end) => end ?? 0))],
    area.left, area.right);
  const title = `${sceneTitle(scene)}, ${technique}: shading cost from which the tighter cull test wins`;
  const svg = drawing(PLOT_WIDTH, area.bottom + 50, title, ...acrossAxis(x, "ns per pixel and light", area),
    ...pairs.flatMap((pair, i) => pairBar(pair, x, area.top + 34 * i, area.right)),
    ...costs.flatMap(({ ns_per_pixel_light: cost, brdf }, i) => {
      const at = x.at(cost), words = `${threeDigits(cost)} ns${brdf ? ` with ${brdf}` : ""} on this machine`;
      return [make("line", { class: "machine", x1: at, x2: at, y1: 16 * i + 16, y2: area.bottom }),
        make("text", { class: "machine-name", x: at, y: 16 * i + 12, "text-anchor": at + 7 * words.length < area.right ? "start" : "end" }, words)];
    }));
  return { title, name: `break-even-${sceneTitle(scene)}-${technique}`, svg };
}

// How series are named: on titles, and along the axis.
const SERIES = {
  lights: ['lights', 'lights'],
  pixels: ['pixels', 'pixels'],
  radius: ['radius', 'radius, over the scene\'s'],
  'equal overlap': ['lights at an equal overlap', 'lights'],
  overlap: ['overlap at an equal number of lights', 'lights that reach a pixel'],
};
const isPlain = (label) => /^[^:]*(:raster=opencl)?$/.test(label);  // a technique as it is

// Times and the line a x^exponent through their mean in logarithms, as it was fitted.
function growthCurve({ technique: label, of, exponent, samples }, x, y) {
  const technique = techniqueOf(label), log = samples.filter((at) => at[0] > 0 && at[1] > 0).map((at) => at.map(Math.log));
  const mean = (i) => log.reduce((sum, at) => sum + at[i], 0) / log.length;
  const fitted = (value) => [x.at(value), y.at(Math.exp(mean(1) + exponent * (Math.log(value) - mean(0))))];
  return [polyline([fitted(samples[0][0]), fitted(samples[samples.length - 1][0])], { stroke: techniqueColor(technique), "stroke-width": 2 }),
    ...samples.map(([value, ms]) => {
      const mark = markerElement(technique, moveTo(x.at(value), y.at(ms)));
      mark.append(make("title", {}, `${label}, ${threeDigits(value)} ${of}: ${threeDigits(ms)} ms`));
      return mark;
    })];
}

function growthPlot(scene, of) {
  const curves =
      page.growth.filter((growth) => growth.scene === scene && growth.of === of && isPlain(growth.technique));
  if (curves.length === 0) return null;
  const area = { left: 60, right: PLOT_WIDTH - 20, top: 36, bottom: 320 }, samples = curves.flatMap((curve) => curve.samples);
  const x = logAxis(samples.map((at) => at[0]), area.left, area.right), y = logAxis(samples.map((at) => at[1]), area.bottom, area.top);
  const names = curves.map(({ technique, exponent, ci95: [low, high] }) => ({ technique: techniqueOf(technique),
    text: `${technique}: exponent ${exponent.toFixed(2)}${low === null || high === null ? "" : ` (${low.toFixed(2)} to ${high.toFixed(2)})`}` }));
  const title = `Time over ${SERIES[of][0]}: ${sceneTitle(scene)}`;
  return {
    title,
    name: `growth-${of.replace(' ', '-')}-${sceneTitle(scene)}`,
    svg: drawing(
        PLOT_WIDTH, 390 + 20 * curves.length, title, ...acrossAxis(x, SERIES[of][1], area),
        ...alongAxis(y, 'ms per frame', area), ...curves.flatMap((curve) => growthCurve(curve, x, y)),
        ...markedNames(names, area.left, area.bottom + 64, 1, 0))
  };
}

// Puts the plots that have anything to show into the element of that id.
function showPlots(id, plots) {
  const drawn = plots.filter((plot) => plot !== null);
  byId(`${id}-part`).hidden = drawn.length === 0;
  byId(id).replaceChildren(...drawn.map(({ title, name, svg }) => {
    const plot = make("div", { class: "drawing" }, svg);
    return make("figure", { class: "chart-card" }, make("figcaption", {}, make("strong", {}, title)), plot, saveButton(plot, name));
  }));
}

function equalFlipPlot(scene, series, flip) {
  const curves = state.clock.equalFlip.filter(
      (curve) => curve.scene === scene && curve.series === series && curve.flip === flip &&
          curve.of === state.reference);
  if (curves.length === 0) return null;
  const area = {left: 60, right: PLOT_WIDTH - 20, top: 36, bottom: 320};
  // All plots of a series have the same axes.
  const all =
      state.clock.equalFlip
          .filter((curve) => curve.scene === scene && curve.series === series && curve.of === state.reference)
          .flatMap((curve) => curve.samples);
  const x = logAxis(all.map((at) => at.x), area.left, area.right),
        y = logAxis(all.map((at) => at.ms), area.bottom, area.top);
  const title = `Time${state.clock.words} at a FLIP of ${flip} over ${SERIES[series][0]}: ${sceneTitle(scene)}`;
  const marks = curves.flatMap(
      ({technique, samples}) =>
          [polyline(
               samples.map((at) => [x.at(at.x), y.at(at.ms)]),
               {stroke: techniqueColor(technique), 'stroke-width': 2}),
           ...samples.map(({x: value, ms, label}) => {
             const mark = markerElement(technique, moveTo(x.at(value), y.at(ms)));
             mark.append(make(
                 'title', {}, `${label}, ${threeDigits(value)} ${SERIES[series][1]}: ${threeDigits(ms)} ms`));
             return mark;
           })]);
  return {
    title,
    name: `flip-${flip}-${series.replace(' ', '-')}-${sceneTitle(scene)}`,
    svg: drawing(
        PLOT_WIDTH, 390 + 20 * Math.ceil(curves.length / 3), title, ...acrossAxis(x, SERIES[series][1], area),
        ...alongAxis(y, `ms per frame${state.clock.words}`, area), ...marks,
        ...markedNames(
            curves.map(({technique}) => ({technique, text: technique})), area.left, area.bottom + 64, 3,
            area.right - area.left))
  };
}

// Times and bytes of passes as stacked bars, the shortest first.
function showPasses(scene) {
  const points = page.points.filter(
      (point) => point.scene === scene && isPlain(point.label) && Object.keys(point.passes).length > 0);
  byId('passes-part').hidden = points.length === 0;
  const stage = (name) => STAGES.findIndex(({passes}) => passes.test(name));
  for (const [id, key, text] of [['pass-times', 'ms', milliseconds], ['pass-bytes', 'bytes', byteNumber]]) {
    const bars = points
                     .map(({label, passes}) => {
                       const parts = Object.entries(passes)
                                         .filter(([, pass]) => pass[key] > 0)
                                         .map(([name, pass]) => ({name, value: pass[key]}))
                                         .sort((a, b) => stage(b.name) - stage(a.name));
                       const total = parts.reduce((sum, part) => sum + part.value, 0);
                       return {name: label, note: ` ${text(total)}`, total, parts};
                     })
                     .filter((bar) => bar.total > 0)
                     .sort((a, b) => a.total - b.total);
    byId(id).hidden = byId(`${id}-legend`).hidden = bars.length === 0;
    if (bars.length > 0) showBars(byId(id), byId(`${id}-legend`), bars, '', stageOf, text, null);
  }
}

function showCosts(scene) {
  showPasses(scene);
  const flips = [...new Set(state.clock.equalFlip.map((curve) => curve.flip))].sort((a, b) => a - b);
  showPlots('equal-flip', [
    'equal overlap', 'overlap'
  ].flatMap((series) => flips.map((flip) => equalFlipPlot(scene, series, flip))));
  showPlots("break-even", page.techniques.map((technique) => breakEvenPlot(scene, technique)));
  showPlots('growth', Object.keys(SERIES).map((of) => growthPlot(scene, of)));
}
