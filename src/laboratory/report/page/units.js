// Keeps each number and its unit on one line: the space between them becomes a no-break space, now and in all
// text that scripts add later. Commands stay as they are, for copying.

const NUMBER_AND_UNIT = /(\d) (?=(%|°C|[nµm]?s|min|k?m|px|EV|W|[kMG]?Hz|[kMG]|([KMG]i)?B|GB\/s)(?![\w/]))/g;

function joinUnits(text) {
  const joined = text.data.replace(NUMBER_AND_UNIT, "$1\u00a0");
  if (joined !== text.data && !text.parentElement?.closest("code, pre, script, style")) text.data = joined;
}

function joinUnitsWithin(node) {
  if (node.nodeType === Node.TEXT_NODE) return joinUnits(node);
  const texts = document.createTreeWalker(node, NodeFilter.SHOW_TEXT);
  while (texts.nextNode()) joinUnits(texts.currentNode);
}

new MutationObserver((changes) => changes.forEach(({ addedNodes }) => addedNodes.forEach(joinUnitsWithin)))
  .observe(document.body, { childList: true, subtree: true });
joinUnitsWithin(document.body);
