// The comparison that ends a training on recordings of one's own.

/** The words of `haptoflow-benchmark evaluate` for a training with these words; null if it has no recordings of its own
 * or writes no model file. */
export function judgementOf(words) {
  const recordings = valuesOf(words, '--recordings');
  const [model] = valuesOf(words, '--export');
  if (recordings.length === 0 || !model || words.includes('--no-judgement')) {
    return null;
  }
  const [labels] = valuesOf(words, '--labels');
  return [
    'evaluate', '--model', model, '--recordings', ...recordings, ...(labels ? ['--labels', labels] : []), '--beside-learn',
  ];
}

function valuesOf(words, option) {
  const whole = words.find((word) => word.startsWith(`${option}=`));
  if (whole) {
    return [whole.slice(option.length + 1)];
  }
  const place = words.indexOf(option);
  if (place < 0) {
    return [];
  }
  const after = words.slice(place + 1);
  const end = after.findIndex((word) => word.startsWith('-'));
  return end < 0 ? after : after.slice(0, end);
}
