// The comparison that ends a training on recordings of one's own.

/** Arguments of the `haptoflow-benchmark evaluate` that judges a training with the arguments `words`; null if there is
 * nothing to judge, because the training has no --recordings, writes no model file (--export), or has --no-judgement. */
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
