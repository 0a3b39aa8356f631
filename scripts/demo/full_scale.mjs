/** The acceleration that is +-1 in a rendered file: the command line's default, as in the C header. */
export const fullScaleMps2 = 200;
