// Moves the playhead, the tip and the moving objects with the sound; a click on a picture seeks.
(() => {
  const trackRateHz = 30;
  const views = document.querySelector('.views');
  const tips = [...views.querySelectorAll('.tip')].map((tip) => ({ tip, places: JSON.parse(tip.dataset.track) }));
  const movers = [...views.querySelectorAll('.mover')].map((mover) => ({ mover, places: JSON.parse(mover.dataset.track) }));
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
    const audio = article.querySelector('audio');
    const lanes = article.querySelector('.lanes');
    const playhead = article.querySelector('.playhead');
    const picture = article.querySelector('.picture');
    const seconds = Number(lanes.dataset.seconds);

    const show = () => {
      playhead.style.left = `${picture.offsetLeft + (picture.offsetWidth * audio.currentTime) / seconds}px`;
      if (article === crossing) moveScene(audio.currentTime);
      if (!audio.paused) requestAnimationFrame(show);
    };
    const reveal = () => {
      article.classList.add('playing');
      if (article === crossing) views.classList.add('playing');
      show();
    };
    audio.addEventListener('play', () => {
      for (const other of document.querySelectorAll('audio')) if (other !== audio) other.pause();
      reveal();
    });
    audio.addEventListener('seeked', reveal);
    lanes.addEventListener('click', (event) => {
      const box = picture.getBoundingClientRect();
      const share = (event.clientX - box.left) / box.width;
      if (share >= 0 && share <= 1) audio.currentTime = share * seconds;
    });
  }
})();
