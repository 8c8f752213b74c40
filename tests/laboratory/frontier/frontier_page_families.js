// Reads what the frontier page shows of families of lights and of passes.
addEventListener('load', () => {
  const all = (selector) => [...document.querySelectorAll(selector)];
  const texts = (selector) => all(selector).map((element) => element.textContent);
  const labels = (selector) => all(selector).map((element) => element.getAttribute('aria-label'));
  const atFlip = () => ({
    titles: texts('#equal-flip figcaption'),
    marks: all('#equal-flip path title').length,
    first: texts('#equal-flip path title')[0] ?? ''
  });
  const seen = {
    faults,
    total: atFlip(),
    growth: texts('#growth figcaption'),
    curves: all('#growth polyline').length,
    times: labels('#pass-times svg'),
    bytes: labels('#pass-bytes svg'),
    hidden: ['front-part', 'table-part', 'passes-part', 'growth-part', 'equal-flip-part'].filter(
        (id) => document.getElementById(id).hidden)
  };
  if (document.getElementById('within').closest('section').hidden) seen.hidden.push('within-part');
  const reference = document.getElementById('reference-choice');
  if (!reference.closest('label').hidden) {
    reference.value = 'authored';
    reference.dispatchEvent(new Event('change'));
  }
  seen.authored = atFlip();
  const outcome = document.createElement('pre');
  outcome.id = 'outcome';
  outcome.textContent = JSON.stringify(seen);
  document.body.append(outcome);
});
