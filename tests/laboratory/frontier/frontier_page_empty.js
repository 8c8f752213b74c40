// Reads what the frontier page shows where nothing ran.
addEventListener("load", () => {
  const outcome = document.createElement("pre");
  outcome.id = "outcome";
  outcome.textContent = JSON.stringify({ faults, reasons: [...document.querySelectorAll("#reasons li")].map((item) => item.textContent),
    hidden: ["within", "break-even-part", "failures-part", "growth-part"].filter((id) => document.getElementById(id).closest("section").hidden) });
  document.body.append(outcome);
});
