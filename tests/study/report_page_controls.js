// Works the controls of the report page and writes what it saw into <pre id="outcome">.
addEventListener("load", () => {
  const get = (id) => document.getElementById(id);
  const column = (n) =>
    [...document.querySelectorAll("tbody tr")].map((line) => line.cells[n]?.firstChild.textContent.trim() ?? "");
  const click = (n) => document.querySelectorAll("thead button")[n].click();
  const slide = (value) => {
    get("cut").value = value;
    get("cut").dispatchEvent(new Event("input"));
    return getComputedStyle(get("left-image")).clipPath;
  };

  const seen = { title: document.title, verdict: get("verdict").textContent };
  seen.left = get("left-picture").selectedOptions[0]?.textContent;
  seen.right = get("right-picture").selectedOptions[0]?.textContent;
  seen.imageSize = [get("left-image").naturalWidth, get("left-image").naturalHeight];
  seen.clips = [50, 12.5, 0, 100].map(slide);
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
  seen.sorted = [...document.querySelectorAll("thead th")].findIndex((th) => th.getAttribute("aria-sort"));

  get("own-scale").click();
  const widthOf = (rect) => parseFloat(rect.getAttribute("width"));
  seen.barWidths = [...document.querySelectorAll(".bar svg")].map((svg) =>
    [...svg.querySelectorAll("rect:not(.track)")].reduce((sum, rect) => sum + widthOf(rect), 0));
  seen.captions = [...document.querySelectorAll("figcaption")].map((caption) => caption.textContent);
  seen.brokenImages = [...document.querySelectorAll("figure img, .legend img")].filter((image) => image.naturalWidth === 0).length;
  seen.skipped = [...get("skipped").children].map((item) => item.textContent);
  seen.overflow = document.documentElement.scrollWidth - document.documentElement.clientWidth;
  document.querySelector("figure button")?.click();
  seen.zoomed = get("zoom").open;
  seen.faults = faults;
  seen.results = results;

  const outcome = document.createElement("pre");
  outcome.id = "outcome";
  outcome.textContent = JSON.stringify(seen);
  document.body.append(outcome);
});
