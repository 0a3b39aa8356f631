/** Full scale of a rendered file in m/s^2: the default of the command line, equal to the one in the C header. */
export const fullScaleMps2 = 200;
