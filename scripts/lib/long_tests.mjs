/**
 * Tests that only the long form runs (`./run test --all`, every night), and why the default run loses nothing by it.
 * Tests/Package/long-tests.test.mjs compares it with the sources.
 * @type {Record<string, {because: string, tests: string[]}[]>} tests: patterns of GoogleTest for native, parts of names of
 *   the others
 */
export const longTests = {
  native: [
    {
      because: 'every pair of labels is rendered from the shipped model; BlendSoundTest blends single pairs, and blend_ribs_test.cpp the arithmetic',
      tests: ['BlendSoundTest.EveryBlendLiesWithinHalfADecibelOfItsLabels'],
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
  training: [
    {
      because: 'the few-shot study is run whole for one material; the tests of its report and of its cases run its parts',
      tests: ['test_a_whole_study_of_one_material_measures_every_row'],
    },
    {
      because: 'dozens of recordings are simulated at every speed; the targets of single materials are tested by test_a_material_measured_afresh_meets_its_targets',
      tests: ['test_the_pooled_centroid_grows_with_speed_as_in_published_textures_and_beyond'],
    },
    {
      because: 'every command of the page of the few-shot study runs; the commands of the page own-materials run in the default form',
      tests: ['test_every_command_of_the_page_runs_and_writes_what_it_names'],
    },
    {
      because: 'a slider is rendered step by step; test_regularity_makes_ribs_stand_out renders another slider',
      tests: ['test_coarseness_lowers_the_pitch_step_by_step_and_hardness_raises_it'],
    },
    {
      because: 'all labels are rendered from the shipped model for minutes and told apart; the classifier and the order of levels have tests of their own on short renders',
      tests: ['test_the_shipped_model_s_renders_of_unseen_strokes_are_classified_correctly_and_ordered_by_level'],
    },
    {
      because: 'recorded strokes are rendered from the shipped model; RealStrokesTests (C#) runs their contact and sound',
      tests: ['test_every_stroke_touches_and_vibrates', 'test_no_sample_is_non_finite_or_clipped', 'test_hop_boundaries_do_not_stand_out_from_the_waveform'],
    },
    {
      because: 'two models are trained and exported to compare their sound; that a shifted level is the label\'s own is tested on the network alone',
      tests: ['test_a_level_shift_in_the_file_scales_the_closed_loop_by_the_same_factor'],
    },
    {
      because: 'a material is calibrated from far off; that it meets its targets as shipped is tested for four materials',
      tests: ['test_calibration_restores_a_detuned_material'],
    },
    {
      because: 'two processes of PyTorch start and find each other; what they compute is tested in one process',
      tests: ['test_two_torchrun_processes_end_with_equal_weights_on_a_machine_whose_name_does_not_resolve'],
    },
    {
      because: 'a network is trained to be compared with fast recordings; the arithmetic of the law is tested without a network',
      tests: ['test_extrapolating_the_level_law_is_closer_to_fast_recordings_than_clamping'],
    },
    {
      because: 'a network of the published sizes is exported and run; test_published_engine.py holds the engine to the authors\' own arrays at small sizes',
      tests: ['test_a_model_of_the_published_sizes_computes_the_same_in_the_engine_as_in_pytorch'],
    },
    {
      because: 'a flow model is distilled whole; the tests beside it render and prepare its recordings, and test_a_cluster_training_has_the_tiers_that_ship_and_states_the_data_set trains and exports such tiers',
      tests: ['test_the_whole_way_from_a_flow_model_to_what_ships'],
    },
    {
      because: 'a model is trained, two steps long, on files from a hub on the loopback address; test_chosen_textures_are_downloaded_once_and_handed_to_the_training stops where the training begins',
      tests: ['test_a_model_of_chosen_textures_has_their_labels_and_licence'],
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
