// Which Python package `./run evaluate` runs.

const ofOneModel = /^--(recordings|model|labels)(=|$)/;

/** `haptoflow_benchmark` for arguments that compare one model with recordings, otherwise `haptoflow_paper`, which measures the rows. */
export const evaluatingPackage = (words) => (words.some((word) => ofOneModel.test(word)) ? 'haptoflow_benchmark' : 'haptoflow_paper');
