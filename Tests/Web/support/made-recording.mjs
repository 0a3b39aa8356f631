const rateHz = 2000;

/** A made recording: noise whose level follows the speed, along a turning path. */
export function recording(seconds) {
  let state = 1;
  const random = () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 4294967296 - 0.5;
  };
  let noise = 0;
  const rows = Array.from({ length: seconds * rateHz }, (_, index) => {
    const time = index / rateHz;
    const speed = 0.12 + 0.09 * Math.sin((2 * Math.PI * time) / 1.7);
    noise = 0.6 * noise + random();
    return [time, 20 * speed ** 0.7 * noise, speed * Math.cos(time / 2), speed * Math.sin(time / 2), 1].map((number) => number.toFixed(5)).join(',');
  });
  return `time_s,acceleration_mps2,velocity_x_mps,velocity_y_mps,force_newtons\n${rows.join('\n')}\n`;
}
