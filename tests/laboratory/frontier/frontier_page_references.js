// Chooses what errors are against, and back, and writes what it saw into <pre id="outcome">.
addEventListener("load", () => {
  const get = (id) => document.getElementById(id);
  const texts = (selector) => [...document.querySelectorAll(selector)].map((element) => element.textContent);
  const choose = (value) => {
    get("reference-choice").value = value;
    get("reference-choice").dispatchEvent(new Event("change"));
  };
  const shown = () => ({ axes: texts("#front svg > text"), front: [...document.querySelectorAll("#front .on-front")].map((mark) => mark.dataset.label),
    band: document.querySelector("#front .band")?.getBBox().width ?? 0, within: get("within").querySelector("tbody tr:last-child button").textContent,
    tagged: [...document.querySelectorAll("#figures-table tbody tr")].map((line) => line.cells[0].textContent).filter((text) => text.includes(" front ")) });
  const seen = { offered: !get("reference-choice").closest("label").hidden, plain: shown() };
  if (seen.offered) {
    choose("authored");
    seen.authored = shown();
    choose("total");
    seen.again = shown();
  }
  seen.faults = faults;
  const outcome = document.createElement("pre");
  outcome.id = "outcome";
  outcome.textContent = JSON.stringify(seen);
  document.body.append(outcome);
});
