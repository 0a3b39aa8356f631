#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;
using System.Threading.Tasks;
using HaptoFlow.Studies;
using UnityEngine;

namespace HaptoFlow.Samples.SimilarityStudy
{
    /// <summary>Builds the study when it wakes: two grey objects side by side, a pen, a panel for the answer, a view
    /// for the operator. It loads and measures every method's model, waits for the alignment and the operator, and then
    /// leads one participant through the plan.</summary>
    [RequireComponent(typeof(PipelineMaterial))]
    public sealed class SimilarityStudyScene : MonoBehaviour
    {
        // So many frames tell how long a frame takes.
        private const int PoseFrames = 64;
        private static readonly Vector3 InstructionPlace = new Vector3(0.13f, 0.195f, 0.2f);
        private static readonly Vector3 PanelPlace = new Vector3(0.13f, 0.12f, 0.2f);

        private readonly PoseInterval poseInterval = new PoseInterval();

        [SerializeField, Tooltip("The materials, the methods and the set-up stand there.")]
        private SimilarityStudySettings? settings;

        [SerializeField]
        private Camera? view;

        private MethodModels? models;
        private TrialParts? parts;
        private GameObject pair = null!;
        private TextMesh instruction = null!;
        private RatingPanel panel = null!;
        private HapticOutput output = null!;
        private MaskingNoise noise = null!;
        private StudyRig rig = null!;
        private bool isRefused;

        /// <summary>The materials, the methods and the set-up. To be set before the component wakes.</summary>
        public SimilarityStudySettings? Settings
        {
            get => settings;
            set => settings = value;
        }

        /// <summary>The participant's eye. To be set before the component wakes.</summary>
        public Camera? View
        {
            get => view;
            set => view = value;
        }

        /// <summary>The virtual object's place is kept under this name; empty to keep nothing. To be set before the
        /// component wakes.</summary>
        public string SaveName { get; set; } = "SimilarityStudy";

        /// <summary>What a method adds to the delay beside the audio block, in ms. To be replaced before the component
        /// wakes where a laboratory has a better measurement.</summary>
        public Func<StudyMethod, HapticLoadedModel, Task<double>> MeasureInference { get; set; } = MeasureLive;

        /// <summary>Puts the virtual object beside the real sample.</summary>
        public SampleAlignment Alignment { get; private set; } = null!;

        /// <summary>Whoever leads the study.</summary>
        public OperatorView Operator { get; private set; } = null!;

        /// <summary>Null before <see cref="Begin"/>.</summary>
        public StudySession? Session { get; private set; }

        /// <summary>Null before <see cref="Begin"/>.</summary>
        public SimilarityProcedure? Procedure { get; private set; }

        /// <summary>Null before <see cref="Begin"/>.</summary>
        public EqualDelay? Delay { get; private set; }

        /// <summary>The methods' models; null where the settings cannot be used.</summary>
        public MethodModels? Models => models;

        /// <summary>The question.</summary>
        public RatingPanel Panel => panel;

        /// <summary>Lies where the real sample is; null where the settings cannot be used.</summary>
        public StudyObject Real { get; private set; } = null!;

        /// <summary>Lies beside it; null where the settings cannot be used.</summary>
        public StudyObject Virtual { get; private set; } = null!;

        /// <summary>The actuator's.</summary>
        public HapticOutput Output => output;

        /// <summary>Why the study cannot begin, or did not when it was last asked to; null where nothing is wrong.
        /// </summary>
        public string? Problem => Operator.Problem;

        /// <summary>Everything is loaded, measured and aligned: <see cref="Begin"/> can be called.</summary>
        public bool CanBegin => !isRefused && Session == null && WhatIsMissing() == null;

        /// <summary>The pen in use: the tracked one; the mouse's as long as none was ever tracked.</summary>
        public HapticStylus Pen => rig.Pen;

        /// <summary>Opens the participant's log, anew or where it was interrupted, and waits for the operator's first
        /// Next. What is wrong stands in <see cref="Problem"/>; nothing has begun then, and it can be tried again.
        /// </summary>
        /// <param name="participant">From 1.</param>
        public void Begin(int participant)
        {
            if (isRefused || Session != null)
            {
                return;
            }
            try
            {
                string? missing = WhatIsMissing() ?? noise.Problem;
                if (missing != null)
                {
                    throw new StudyException(missing);
                }
                StudyLog log = OpenLog(participant);
                parts = new TrialParts(
                    settings!, models!, Delay!, Real, Virtual, rig, output, panel, instruction);
                Session = new StudySession(log);
                Procedure = SimilarityProcedure.Create(Session, parts);
                Operator.Session = Session;
                Operator.Problem = null;
            }
            catch (StudyException refusal)
            {
                Operator.Problem = refusal.Message;
            }
        }

        private void Awake()
        {
            // Until the first trial the pen belongs to the model of the project, where it has one.
            HaptoFlowSettings active = HaptoFlowSettings.Active;
            if (active.Model == null && settings != null)
            {
                active.Model = settings.Methods.Select(each => each.Model).FirstOrDefault(each => each != null);
            }
            Quaternion facing = view!.transform.rotation;
            rig = StudyRig.Create(view, settings != null ? settings.PenHand : PenHand.Right);
            MakeOutput();
            rig.PlayOn(output);
            instruction = Build.Text("Please wait.", InstructionPlace, facing);
            panel = RatingPanel.Create(PanelPlace, facing);
            RatingButtons.Create(panel, settings != null ? settings.PenHand : PenHand.Right);
            Operator = gameObject.AddComponent<OperatorView>();
            Operator.Output = output;
            Operator.Detail = Detail;
            Operator.Begin = Begin;
            AlignmentButtons.Create(this);
            pair = new GameObject("Objects");
            Alignment = SampleAlignment.Create(pair, rig, SaveName);
            Prepare();
        }

        private void Prepare()
        {
            try
            {
                if (settings == null)
                {
                    throw new StudyException("no settings are chosen; choose an asset in the field Settings");
                }
                settings.Check();
                MakeObjects(settings);
                Alignment.SetSample(settings.SampleMetres, settings.PlateUnderVirtual);
                models = new MethodModels(settings, MeasureInference);
            }
            catch (StudyException refusal)
            {
                Stop(refusal);
            }
        }

        private void Update()
        {
            poseInterval.Add(Time.unscaledDeltaTime);
            PauseWhereTheModelEnded();
            if (isRefused || models == null || models.IsReady)
            {
                return;
            }
            try
            {
                models.Update();
            }
            catch (StudyException refusal)
            {
                Stop(refusal);
            }
        }

        /// <summary>What is felt without its model would be rated as if it were the method's.</summary>
        private void PauseWhereTheModelEnded()
        {
            string? method = Procedure != null && Procedure.Stage != TrialStage.Waiting ? Session!.Trial!.Method : null;
            string? problem = method != null ? models!.Of(method).Problem : null;
            if (problem != null)
            {
                Session!.PauseHere();
                Operator.Problem = $"method \"{method}\": {problem}; start the application again, the session goes " +
                    "on with this trial";
            }
        }

        private void OnDestroy()
        {
            if (Procedure != null)
            {
                Destroy(Procedure.gameObject);
            }
            parts?.Dispose();
            models?.Dispose();
        }

        private void Stop(StudyException refusal)
        {
            isRefused = true;
            Operator.Problem = refusal.Message;
        }

        private StudyLog OpenLog(int participant)
        {
            StudyPlan plan = settings!.PlanFor(participant);
            double? wanted = EqualDelay.OfInterrupted(settings.Folder, participant);
            if (wanted == null && settings.EqualDelayMilliseconds > 0f)
            {
                wanted = settings.EqualDelayMilliseconds;
            }
            Delay = new EqualDelay(DelaysOfMethods(), wanted);
            var description = new StudyDescription(plan, settings.ForLog(), Delay.Of(Delay.Slowest))
            {
                IsSimulated = settings.Simulated,
                Environment = EnvironmentOf(settings),
                Models = models!.ForLog(),
            };
            return StudyLog.Open(settings.Folder, description);
        }

        private Dictionary<string, SystemDelay> DelaysOfMethods() => settings!.Methods.ToDictionary(
            each => each.Name,
            each => new SystemDelay(poseInterval.MedianMilliseconds, models!.InferenceMilliseconds(each.Name),
                StudyPlayer.BlockMilliseconds, settings.DeviceDelayMilliseconds),
            StringComparer.Ordinal);

        private static StudyEnvironment EnvironmentOf(SimilarityStudySettings chosen)
        {
            StudyEnvironment environment = StudyPlayer.Environment(chosen.Headset);
            environment.DeviceDelaySource = chosen.DeviceDelaySource;
            environment.DeviceDelayNote = chosen.DeviceDelayNote;
            return environment;
        }

        private void MakeOutput()
        {
            GameObject ears = view!.gameObject;
            noise = ears.AddComponent<MaskingNoise>();
            // Behind the noise: the output overwrites its channel.
            output = ears.AddComponent<HapticOutput>();
            output.Route = OutputRoute.ListenerChannel;
            output.Channel = settings != null ? settings.HapticChannel : 1;
            // Nothing is felt before the first trial.
            output.Muted = true;
            noise.Output = output;
            if (settings != null)
            {
                noise.Colour = settings.NoiseColour;
                noise.LevelDecibels = settings.NoiseDecibels;
            }
        }

        private void MakeObjects(SimilarityStudySettings chosen)
        {
            Real = new StudyObject("Left Object", pair.transform, Vector3.zero, chosen.SampleMetres,
                chosen.RealHeightMetres, NewTracing(chosen));
            Real.Surface.Material.Effects = HapticEffects.Nothing;
            Virtual = new StudyObject("Right Object", pair.transform, chosen.VirtualMetres, chosen.SampleMetres, 0f,
                NewTracing(chosen));
        }

        private static EdgeTracing NewTracing(SimilarityStudySettings chosen) => new EdgeTracing(
            chosen.SampleMetres.x, chosen.SampleMetres.z, chosen.EdgeToleranceMetres, chosen.EdgeShare);

        private string? WhatIsMissing()
        {
            if (models == null || !models.IsReady)
            {
                return models?.Doing;
            }
            if (poseInterval.Count < PoseFrames)
            {
                return "measuring how long a frame takes";
            }
            return settings!.NeedsAlignment && !Alignment.Alignment.IsAligned
                ? "put the virtual object beside the real sample: press Align"
                : null;
        }

        private string Detail()
        {
            if (Session == null)
            {
                return $"{WhatIsMissing() ?? "ready: press Begin"}\npen: {Pen.name}\n{Alignment.Text}";
            }
            PlannedTrial? trial = Session.Trial;
            return trial == null
                ? ""
                : FormattableString.Invariant($"mount the sample \"{trial.Material}\"; method \"{trial.Method}\"\n") +
                    FormattableString.Invariant($"delay {Delay!.Milliseconds:0.0} ms, ") +
                    FormattableString.Invariant($"{Delay.ArtificialMilliseconds(trial.Method!):0.0} of them added; ") +
                    StageWords();
        }

        private string StageWords() => Procedure!.Stage switch
        {
            TrialStage.RealEdges => $"edges of the real sample: {Real.Tracing.TracedEdges} of 4",
            TrialStage.VirtualEdges => $"edges of the virtual object: {Virtual.Tracing.TracedEdges} of 4",
            TrialStage.Free => "both freely, the question is open",
            _ => "waiting",
        };

        private static async Task<double> MeasureLive(StudyMethod method, HapticLoadedModel model)
        {
            AudioSettings.GetDSPBufferSize(out int frames, out _);
            double blockMilliseconds = StudyPlayer.BlockMilliseconds;
            HapticModelDelay delay = await model.MeasureDelay(AudioSettings.outputSampleRate, frames)
                .ConfigureAwait(false);
            // The lead holds the block that a segment waits for; the rest is the method's own.
            return Math.Max(delay.InferenceMedianMilliseconds, delay.LeadMilliseconds - blockMilliseconds);
        }
    }
}
