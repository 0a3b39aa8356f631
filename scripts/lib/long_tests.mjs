/**
 * Tests that only the long form runs (`./run test --all`, every night), and why the default run loses nothing by it.
 * @type {Record<string, {because: string, tests: string[]}[]>} tests: patterns of GoogleTest for native, parts of names of
 *   the others
 */
export const longTests = {
  native: [
    {
      because: 'every pair of labels is rendered from the shipped model; BlendSoundTest blends single pairs, and BlendRibsTest tests the arithmetic',
      tests: ['BlendSoundTest.EveryBlendLiesBetweenItsLabelsOrAtMostTwoDecibelsBelow'],
    },
    {
      because: 'the command line is started for every example of every help text; EveryCommandLineOfEveryPageRuns starts it for those of the pages',
      tests: ['DocumentationExamplesTest.EveryExampleOfTheHelpRuns'],
    },
    {
      because: 'materials are learnt three times over; LearnCommandTest.ATableGivesMaterialReportAndPictureWithEqualBytesEachTime learns two by the command line',
      tests: ['LearnerTest.EqualSeedsGiveEqualBytesAndAnotherSeedAnotherMaterial'],
    },
    {
      because: 'the figures of the benchmark are measured once more for each device; TheReportHoldsEveryFigureOfTheContractWithTheRatioToItsReference reads a whole report',
      tests: ['BenchCommandTest.LatenciesHaveARowForEachDeviceWithItsGoalAfterTheDefaultBlocksFigures'],
    },
  ],
  dotnet: [
    {
      because: 'a material is learnt to its end; another learning to its end stays, and cancelling, saving and options have tests of their own',
      tests: ['TouchingTheButtonLearnsTheRecordingForTheSpecimen'],
    },
  ],
};

/** The names of a runner's long tests. */
export const longTestsOf = (runner) => longTests[runner].flatMap(({ tests }) => tests);
