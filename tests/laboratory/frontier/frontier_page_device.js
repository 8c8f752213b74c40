// Reads what the frontier page shows of fronts by each clock and against each reference, with `visibility` chosen.
addEventListener("load", () => {
  const get = (id) => document.getElementById(id);
  const texts = (selector) => [...document.querySelectorAll(selector)].map((element) => element.textContent);
  const choose = (id, value) => {
    get(id).value = value;
    get(id).dispatchEvent(new Event("change"));
  };
  // Where times are exact, the band is as wide as the front.
  const bandIsFront = () => {
    const band = document.querySelector("#front .band").getBBox();
    const places = [...document.querySelectorAll("#front .on-front")].map((mark) => mark.transform.baseVal[0].matrix.e);
    return Math.abs(band.x - Math.min(...places)) < 1 && Math.abs(band.x + band.width - Math.max(...places)) < 1;
  };
  const shown = () => ({ front: [...document.querySelectorAll("#front .on-front")].map((mark) => mark.dataset.label).sort(), bandIsFront: bandIsFront(),
    tagged: texts("#figures-table tbody tr > :first-child").filter((text) => text.includes(" front ")).map((text) => text.split(" front ")[0].trim()).sort(),
    summary: get("chosen").textContent });
  const seen = { faults, axis: get("x-choice").value, axes: [...get("x-choice").options].map((option) => option.value), columns: texts("#figures-table th"), first: shown() };
  for (const reference of ["total", "authored"]) {
    choose("reference-choice", reference);
    [...document.querySelectorAll("#figures-table button")].find((button) => button.textContent === "visibility").click();
    for (const axis of ["relative", "relative_device"]) {
      choose("x-choice", axis);
      seen[`${axis} ${reference}`] = shown();
    }
  }
  const outcome = document.createElement("pre");
  outcome.id = "outcome";
  outcome.textContent = JSON.stringify(seen);
  document.body.append(outcome);
});
