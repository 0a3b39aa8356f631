// Runs before the first module and says in plain HTML why none starts. An old browser understands this much: no module, no new syntax.
(function () {
  function say(text) {
    var box = document.getElementById('not-started');
    // Once the page has started it speaks for itself.
    if (!box) return;
    box.className = 'is-known';
    box.textContent = text;
  }

  function whyNotLoaded() {
    if (location.protocol === 'file:') return 'The page cannot be opened as a file: serve its folder, as ./run play does.';
    if (window.origin === 'null') return 'The page stands in a sandboxed frame without an origin: its sandbox needs allow-same-origin, or its server must send Access-Control-Allow-Origin: *.';
    return 'A script of the page could not be loaded. The server must have every file and send .mjs files as text/javascript, and a blocker must let them through. The browser\'s console names the file.';
  }

  var tooOld = 'This browser may be too old: the page needs one of 2023 or later.';
  window.addEventListener('error', function (event) {
    var target = event.target;
    if (target && target.nodeName === 'SCRIPT') say(whyNotLoaded());
    else if (/SyntaxError/.test(event.message)) say('A script of the page cannot be read (' + event.filename + ': ' + event.message + '). ' + tooOld + ' Or a blocker has changed the script.');
    else if (event.message) say('The page could not start: ' + event.message + ' (' + event.filename + '). ' + tooOld);
  }, true);
  if (!('noModule' in document.createElement('script'))) say(tooOld);
})();
