// Works the controls of the frontier page and writes what it saw into <pre id="outcome">.
addEventListener("load", async () => {
  const get = (id) => document.getElementById(id);
  const texts = (selector) => [...document.querySelectorAll(selector)].map((element) => element.textContent);
  const change = (id, value) => {
    get(id).value = value;
    get(id).dispatchEvent(new Event("change"));
  };
  const placeOf = (element) => element.getAttribute("transform").match(/[\d.]+/g).map(Number);
  const marks = () => [...document.querySelectorAll("#front .point")].map((element) => ({ label: element.dataset.label,
    at: placeOf(element), front: element.classList.contains("on-front"), selected: element.classList.contains("selected") }));
  const axes = () => texts("#front svg > text");
  const pointer = (type, label) => {
    const box = get("front").getBoundingClientRect(), [x, y] = marks().find((mark) => mark.label === label).at;
    get("front").dispatchEvent(new PointerEvent(type, { clientX: box.left + get("front").clientLeft + x + 2, clientY: box.top + get("front").clientTop + y - 2, bubbles: true }));
  };
  const key = (name) => get("front").dispatchEvent(new KeyboardEvent("keydown", { key: name, bubbles: true, cancelable: true }));
  const tip = () => (document.querySelector("#front .tip").hidden ? null : texts("#front .tip p"));
  const chosen = async () => {
    const images = [...get("chosen").querySelectorAll("img")];
    while (images.some((image) => !image.complete)) await new Promise((resolve) => setTimeout(resolve, 1));
    return { name: get("chosen").querySelector("h3")?.textContent ?? null, sizes: images.map((image) => [image.naturalWidth, image.naturalHeight]),
      text: get("chosen").textContent };
  };

  const seen = { title: document.title, paragraph: get("paragraph").textContent, verdict: get("verdict").textContent, names: document.querySelectorAll("#front .point-name").length, marks: marks(), axes: axes(), band: document.querySelector("#front .band")?.getBBox().width ?? 0,
    step: document.querySelector("#front .step").getAttribute("points"), first: await chosen() };
  seen.within = [...get("within").querySelectorAll("tbody tr")].map((line) => [...line.cells].map((cell) => [...cell.children].map((part) => part.textContent).join("|") || cell.textContent));
  seen.failures = [...get("failures").querySelectorAll("tbody tr")].map((line) => [...line.cells].map((cell) => cell.textContent));
  seen.reasons = texts("#reasons li");

  pointer("pointermove", "clustered");
  seen.hovered = tip();
  get("front").dispatchEvent(new PointerEvent("pointerleave"));
  seen.left = tip();
  pointer("click", "deferred");
  seen.clicked = await chosen();

  get("front").focus();
  key("Escape");
  key("ArrowRight");
  seen.firstByKey = tip()?.[0];
  key("ArrowRight");
  seen.secondByKey = tip()?.[0];
  key("Enter");
  seen.chosenByKey = (await chosen()).name;
  key("Escape");

  change("x-choice", "listed");
  change("y-choice", "model.max_rel");
  seen.changed = { axes: axes(), marks: marks(), band: document.querySelectorAll("#front .band").length };
  change("x-choice", "ms");
  seen.overMs = marks();
  change("x-choice", "relative");
  change("y-choice", "total.displayed_flip");

  const technique = [...document.querySelectorAll("#techniques button")].find((button) => button.textContent === "visibility");
  technique.click();
  seen.withoutVisibility = { labels: marks().map((mark) => mark.label), pressed: technique.getAttribute("aria-pressed") };
  technique.click();

  seen.saved = { front: svgText(document.querySelector("#front svg")),
    others: [...document.querySelectorAll("#break-even svg, #growth svg")].map(svgText) };
  seen.bars = texts("#break-even .wins title");
  seen.pairs = texts("#break-even text").filter((text) => text.includes(" over "));
  seen.machine = texts("#break-even .machine-name");
  seen.growth = texts("#growth text").filter((text) => text.includes("exponent"));
  seen.drawn = [...document.querySelectorAll("#break-even svg, #growth svg")].every((svg) => svg.getBoundingClientRect().height > 50);
  const names = () => [...document.querySelectorAll("#figures-table tbody tr")].map((line) => line.cells[0].textContent);
  seen.byTime = names();
  document.querySelectorAll("#figures-table thead button")[3].click();
  seen.byError = names();

  change("scene-choice", page.scenes[1].key);
  seen.second = { labels: marks().map((mark) => mark.label), chosen: await chosen(), plots: texts("#break-even figcaption") };
  get("within").querySelector("tbody button").click();  // a point of the first scene
  seen.followed = { scene: get("scene-choice").selectedOptions[0].textContent, name: (await chosen()).name };
  get("chosen").querySelector("figure button")?.click();
  seen.zoomed = get("zoom").open;
  get("zoom").close();

  seen.overflow = document.documentElement.scrollWidth - document.documentElement.clientWidth;
  seen.unlabelled = [...document.querySelectorAll("select")].filter((select) => !select.closest("label")).length;
  seen.faults = faults;
  seen.loaded = performance.getEntriesByType("resource").map((entry) => entry.name).filter((name) => !name.startsWith("data:"));
  const outcome = document.createElement("pre");
  outcome.id = "outcome";
  outcome.textContent = JSON.stringify(seen);
  document.body.append(outcome);
});
