const counters = ['seconds', 'rms_mps2', 'peak', 'segments', 'nonfinite', 'underruns'];

/**
 * out/demo/report.json from the reports that `haptoflow render --report` wrote, one for each render.
 * @param {{name: string, report: object}[]} renders `name` is the demo's own for the render
 * @returns {{model: string, renders: object[]}}
 * @throws RangeError naming the render and the key that is missing or no finite number
 */
export function assembleReport(renders) {
  const models = [...new Set(renders.map(({ report }) => report.model))];
  if (models.length !== 1 || typeof models[0] !== 'string') {
    throw new RangeError(`the renders' reports must name one and the same model, found: ${models.join(', ') || 'none'}`);
  }
  return { model: models[0], renders: renders.map(({ name, report }) => summary(name, report)) };
}

function summary(name, report) {
  const number = (value, key) => {
    if (!Number.isFinite(value)) throw new RangeError(`report of "${name}": "${key}" must be a finite number, found ${JSON.stringify(value)}`);
    return value;
  };
  if (!Array.isArray(report.labels) || report.labels.length === 0) {
    throw new RangeError(`report of "${name}": "labels" must be a list of one or more labels`);
  }
  if (typeof report.wav !== 'string') throw new RangeError(`report of "${name}": "wav" must name the file`);
  const [seconds, rms, peak, segments, nonfinite, underruns] = counters.map((key) => number(report[key], key));
  const inference = { p50: number(report.inference_ms?.p50, 'inference_ms.p50'), p99: number(report.inference_ms?.p99, 'inference_ms.p99') };
  return { name, labels: report.labels, wav: report.wav, seconds, rms_mps2: rms, peak, segments, inference_ms: inference, nonfinite, underruns };
}
