// The controls of several views: the matrix, the curves, the chooser.
function tryViews(get, column) {
  const several = { sentences: [...get("overview-sentences").children].map((item) => item.textContent) };
  several.matrix = [...document.querySelectorAll(".matrix tbody tr")].map((line) =>
    [...line.cells].map((cell) => cell.firstChild.textContent));
  several.winners = document.querySelectorAll(".matrix .winner").length;
  several.notes = [...document.querySelectorAll(".matrix .note")].map((note) => note.textContent);
  several.charts = [...document.querySelectorAll("#curves .chart")].map((chart) => ({
    curves: [...chart.querySelectorAll(".curve")].map((curve) => ({
      name: curve.dataset.name,
      points: [...curve.querySelectorAll("circle")].map((dot) => ({
        view: Number(dot.dataset.view), row: Number(dot.dataset.row), x: Number(dot.getAttribute("cx")), y: Number(dot.getAttribute("cy")),
      })),
    })),
    rings: chart.querySelectorAll(".crossing").length,
  }));
  const name = document.querySelector(".curve-names button");
  name.click();
  several.hidden = [...document.querySelectorAll("#curves .chart .curve")].filter((curve) => curve.style.display === "none").length;
  name.click();
  const shown = () => ({ title: get("view-title").textContent, verdict: get("verdict").textContent, times: column(1),
    picture: get("left-image").src, choice: get("view-choice").selectedOptions[0].textContent });
  several.first = shown();
  get("view-choice").selectedIndex = 1;
  get("view-choice").dispatchEvent(new Event("change"));
  several.second = shown();
  document.querySelectorAll(".matrix thead button")[2].click();
  several.third = shown();
  return several;
}

// The page as a sheet of paper has it: print rules for all, at the width that @page leaves of A4. Returns what is cut.
function tryPrint() {
  for (const sheet of document.styleSheets) {
    for (const rule of sheet.cssRules) if (rule.media?.mediaText === "print") rule.media.mediaText = "all";
  }
  document.body.style.width = "1031px";  // 297 mm less two margins of 12 mm, at 96 dots an inch
  dispatchEvent(new Event("resize"));
  const right = document.body.getBoundingClientRect().right;
  return [...document.querySelectorAll("main *:not(option):not(optgroup)")]
    .filter((element) => element.offsetParent !== null && element.getBoundingClientRect().right > right + 1 && !element.closest("#slider"))
    .map((element) => `${element.tagName} ${element.id} ${element.className} ${element.textContent.slice(0, 40)}`);
}

// Enlarges, reads a pixel, keeps the choice in the address and takes it from there.
function trySlider(get) {
  const slider = { at: [] };
  slide(get, 25);
  get("left-picture").selectedIndex = 0;
  get("left-picture").dispatchEvent(new Event("change"));
  get("zoom-in").click();
  slider.scale = get("zoom-scale").textContent;
  slider.transforms = ["left", "right"].map((side) => get(`${side}-image`).style.transform);
  keepState();
  slider.hash = decodeURIComponent(location.hash);
  get("zoom-all").click();
  slider.whole = get("left-image").style.transform;
  setSliderState({ left: "lidr", right: "truly lit", cut: "75", zoom: "4,0.5,0.25" });
  slider.set = sliderState();
  slider.ramp = [0, 0.5, 1].map((share) => {
    const ramp = ramps[page.heat_legend], at = Math.round(share * (ramp.length / 4 - 1));
    return heatValue(60)([...ramp.slice(4 * at, 4 * at + 3)]);
  });
  slider.none = heatValue(60)([0, 0, 0]);
  readPixel(0, 0);
  slider.pixel = get("pixel").textContent;
  setSliderState({ zoom: "1,0,0" });
  return slider;
}

function slide(get, value) {
  get("cut").value = value;
  get("cut").dispatchEvent(new Event("input"));
  return getComputedStyle(get("left-part")).clipPath;
}

// The passes of this program: a stage without a color of its own is "other".
const PASSES = `blend_resolved build_voxels build_world_grid cull_lights cull_lights_for_blended depth_bounds depth_prepass
  depth_to_cl draw_light_buffer fill_gbuffer fill_light_buffer fill_normals find_blended_object_lights find_object_lights
  gbuffer_to_cl grid_to_gl image_to_gl light_buffer_to_gl light_index light_volumes list_blended normals_to_cl place_voxels
  rasterize read_back resolve resolve_gbuffer resolve_materials resolve_normals shade_blended shade_forward
  shade_light_volumes shade_objects shade_tiles tile_distances update_world_grid voxels_to_gl`.split(/\s+/);

// Works the controls of the report page and writes what it saw into <pre id="outcome">.
addEventListener("load", () => {
  const get = (id) => document.getElementById(id);
  const column = (n) =>
    [...document.querySelectorAll("#figures-table tbody tr")].map((line) => line.cells[n]?.firstChild.textContent.trim() ?? "");
  const click = (n) => document.querySelectorAll("#figures-table thead button")[n].click();

  const seen = { title: document.title, verdict: get("verdict").textContent };
  seen.left = get("left-picture").selectedOptions[0]?.textContent;
  seen.right = get("right-picture").selectedOptions[0]?.textContent;
  seen.imageSize = [get("left-image").naturalWidth, get("left-image").naturalHeight];
  seen.clips = [50, 12.5, 0, 100].map((value) => slide(get, value));
  get("cut").focus();
  seen.focused = document.activeElement.id;
  const before = get("right-image").src;
  get("right-picture").selectedIndex = get("right-picture").options.length - 1;
  get("right-picture").dispatchEvent(new Event("change"));
  seen.pictureChanged = get("right-image").src !== before;

  seen.byTime = [column(0), column(1)];
  click(1);
  seen.byTimeDescending = column(0);
  click(0);
  seen.byName = column(0);
  click(2);
  seen.bySpeedUp = column(0);
  seen.lost = column(4);
  seen.sorted = [...document.querySelectorAll("#figures-table thead th")].findIndex((th) => th.getAttribute("aria-sort"));

  seen.choices = [...get("choices").children].map((card) => [...card.children].map((part) => part.textContent));
  seen.figures = [...get("figures").children].map((item) => item.textContent);
  seen.markdown = tableText(get("figures-table"), "Markdown").split("\n");
  seen.csv = tableText(get("figures-table"), "CSV").split("\n");
  seen.copies = document.querySelectorAll("#figures-copy button").length;
  seen.legend = [...document.querySelectorAll("#pass-legend li")].map((item) => [item.textContent, item.querySelector("i").style.background]);
  seen.strayPasses = PASSES.filter((name) => stageOf(name).name === "other");
  if (!get("slider").closest("section").hidden) seen.slider = trySlider(get);

  get("own-scale").click();
  const widthOf = (rect) => parseFloat(rect.getAttribute("width"));
  seen.barWidths = [...document.querySelectorAll(".bar svg")].map((svg) =>
    [...svg.querySelectorAll("rect:not(.track)")].reduce((sum, rect) => sum + widthOf(rect), 0));
  seen.captions = [...document.querySelectorAll("figcaption")].map((caption) => caption.textContent);
  seen.brokenImages = [...document.querySelectorAll("figure img, .legend img")].filter((image) => image.naturalWidth === 0).length;
  seen.overviewHidden = get("overview").hidden && get("view-part").hidden;
  seen.memory = [...document.querySelectorAll("#memory-bars .bar p span")].map((span) => span.textContent);
  seen.settingsCharts = get("settings-part").hidden ? 0 : document.querySelectorAll("#settings-charts .chart").length;
  if (views.length > 1) seen.several = tryViews(get, column);
  seen.skipped = [...get("skipped").children].map((item) => item.textContent);
  seen.planChanges = get("plan-changes").hidden ? null : {
    title: get("plan-changes").querySelector("h3").textContent,
    lines: [...document.querySelectorAll(".changes tbody tr")].map((line) =>
      [...line.cells].map((cell) => cell.textContent)),
    folded: document.querySelectorAll("#plan-changes details tbody tr").length,
    text: get("plan-changes").querySelector("p")?.textContent ?? "",
  };
  seen.overflow = document.documentElement.scrollWidth - document.documentElement.clientWidth;
  document.querySelector("figure button")?.click();
  seen.zoomed = get("zoom").open;
  get("zoom").close();
  seen.cutInPrint = tryPrint();
  seen.faults = faults;
  seen.loaded = performance.getEntriesByType("resource").map((entry) => entry.name).filter((name) => !name.startsWith("data:"));
  seen.results = results;

  const outcome = document.createElement("pre");
  outcome.id = "outcome";
  outcome.textContent = JSON.stringify(seen);
  document.body.append(outcome);
});
