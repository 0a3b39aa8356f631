// Each player has one button that plays and pauses; arrow keys seek. Playhead, tip and moving objects follow the sound.
(() => {
  const trackRateHz = 30;
  const seekSeconds = 0.5;
  const stage = document.querySelector('.stage');
  const tips = [...stage.querySelectorAll('.tip')].map((tip) => ({ tip, places: JSON.parse(tip.dataset.track) }));
  const movers = [...stage.querySelectorAll('.mover')].map((mover) => ({ mover, places: JSON.parse(mover.dataset.track) }));
  const crossing = document.querySelector('article.render');

  const placeAt = (places, seconds) => {
    const at = Math.min(seconds * trackRateHz, places.length - 1);
    const from = places[Math.floor(at)];
    const to = places[Math.min(Math.floor(at) + 1, places.length - 1)];
    return from.map((value, axis) => value + (at % 1) * (to[axis] - value));
  };

  const moveScene = (seconds) => {
    for (const { tip, places } of tips) {
      const [x, y] = placeAt(places, seconds);
      tip.setAttribute('cx', x);
      tip.setAttribute('cy', y);
    }
    for (const { mover, places } of movers) mover.setAttribute('transform', `translate(${placeAt(places, seconds).join(' ')})`);
  };

  for (const article of document.querySelectorAll('article.render')) {
    const [audio, button, clock, lanes, playhead] = ['audio', 'button', 'output', '.lanes', '.playhead']
      .map((selector) => article.querySelector(selector));
    const [seconds, left, width] = ['seconds', 'left', 'width'].map((key) => Number(lanes.dataset[key]));

    const show = () => {
      playhead.style.left = `${100 * (left + (width * audio.currentTime) / seconds)}%`;
      clock.textContent = `${audio.currentTime.toFixed(1)} / ${seconds.toFixed(1)} s`;
      if (article === crossing) moveScene(audio.currentTime);
      if (!audio.paused) requestAnimationFrame(show);
    };
    const reveal = () => {
      article.classList.add('playing');
      if (article === crossing) stage.classList.add('playing');
      show();
    };
    const label = () => {
      button.setAttribute('aria-label', `${audio.paused ? 'Play' : 'Pause'} ${button.dataset.name}; arrow keys seek`);
      button.classList.toggle('pause', !audio.paused);
    };
    const seek = (to) => {
      audio.currentTime = Math.min(Math.max(to, 0), seconds);
    };

    label();
    for (const event of ['play', 'pause', 'ended']) audio.addEventListener(event, label);
    audio.addEventListener('play', () => {
      for (const other of document.querySelectorAll('audio')) if (other !== audio) other.pause();
      reveal();
    });
    audio.addEventListener('seeked', reveal);
    button.addEventListener('click', () => (audio.paused ? audio.play() : audio.pause()));
    button.addEventListener('keydown', (event) => {
      const places = { ArrowLeft: audio.currentTime - seekSeconds, ArrowRight: audio.currentTime + seekSeconds, Home: 0, End: seconds };
      if (!(event.key in places)) return;
      event.preventDefault();
      seek(places[event.key]);
    });
    lanes.addEventListener('click', (event) => {
      const box = lanes.getBoundingClientRect();
      const share = ((event.clientX - box.left) / box.width - left) / width;
      if (share >= 0 && share <= 1) seek(share * seconds);
    });
  }
})();
