// Fills the page from results.json and the pictures, both embedded above.

const results = JSON.parse(byId("results").textContent);
const page = JSON.parse(byId("page").textContent);
const views = (results.views ?? [results]).map((of_view, i) => ({ results: of_view, page: page.views[i] }));
let redraws = [];     // of the view shown
let redrawsOfAll = [];

const sceneOf = (view) => view.results.scene.split(/[/\\]/).pop();

function showHeader() {
  const first = views[0].results;
  const scenes = [...new Set(views.map(sceneOf))].join(", ");
  document.title = `${scenes} \u2013 lightgrid compare`;
  byId("scene").textContent = scenes;
  const lights = first.rows[0]?.lights;
  byId("view").textContent = [
    ...(views.length > 1 ? [`${views.length} views`] : [
      `${first.size[0]} \u00d7 ${first.size[1]}`,
      lights && `${wholeNumber(lights.total)} lights, ${wholeNumber(lights.in_view)} in view`,
      first.exposure?.ev && `pictures exposed by ${first.exposure.ev} EV`]),
    `OpenCL: ${first.devices.cl}`,
    `OpenGL: ${first.devices.gl}`,
    `commit ${first.commit}`,
  ].filter(Boolean).join(" \u00b7 ");
}

function chooseView(number) {
  byId("view-choice").value = number;
  redraws = showView(views[number]);
}

function startOverview() {
  byId("overview").hidden = byId("view-part").hidden = views.length < 2;
  if (views.length < 2) return;
  byId("overview-sentences").replaceChildren(...page.overview.sentences.map((line) => make("li", {}, line)));
  byId("matrix-copy").replaceChildren(...copyButtons(() => byId("matrix")));
  showMatrix(byId("matrix"), views, (number) => {
    chooseView(number);
    byId("view-part").scrollIntoView();
  });
  byId("curves-part").hidden = page.overview.charts.length === 0;
  redrawsOfAll = [showCharts(byId("curves"), page.overview.charts)];
  byId("view-choice").replaceChildren(...views.map((view, i) => make("option", { value: i }, view.page.title)));
  byId("view-choice").addEventListener("change", () => {
    chooseView(Number(byId("view-choice").value));
    keepState();
  });
}

// The address keeps the view and the slider's pictures, so that a link shows the same.
let stateInAddress = "", keeping = 0;
function keepState() {
  clearTimeout(keeping);
  const view = views.length > 1 ? { view: byId("view-choice").value } : {};
  stateInAddress = `#${new URLSearchParams({ ...view, ...sliderState() })}`;
  location.replace(stateInAddress);
}
function keepStateSoon() {
  clearTimeout(keeping);
  keeping = setTimeout(keepState, 300);
}
function readState() {
  if (location.hash.length < 2 || location.hash === stateInAddress) return;
  const state = Object.fromEntries(new URLSearchParams(location.hash.slice(1)));
  if (state.view && views[state.view]) chooseView(Number(state.view));
  setSliderState(state);
}

const redrawAll = () => [...redrawsOfAll, ...redraws].forEach((draw) => draw());

showHeader();
showWarnings(views.flatMap((view) => view.results.warnings));
[page.difference_legend, page.heat_legend].forEach(loadRamp);
startSlider(keepStateSoon);
startOverview();
chooseView(0);
readState();
addEventListener("hashchange", readState);
byId("own-scale").addEventListener("change", redrawAll);
addEventListener("resize", redrawAll);
