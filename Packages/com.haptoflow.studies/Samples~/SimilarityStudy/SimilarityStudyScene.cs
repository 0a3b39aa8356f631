#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;
using System.Threading.Tasks;
using HaptoFlow.Studies;
using UnityEngine;

namespace HaptoFlow.Samples.SimilarityStudy
{
    /// <summary>Builds the study when it wakes: two grey objects side by side, a pen, a panel for the answers, a view
    /// for the operator. It loads every method's model and measures its delay, waits for the alignment and the
    /// operator, and then leads one participant through the plan. The scene's camera has to carry the Audio
    /// Listener.</summary>
    public sealed class SimilarityStudyScene : BuiltScene
    {
        private static readonly Vector3 InstructionPlace = new Vector3(0.13f, 0.195f, 0.2f);
        private static readonly Vector3 PanelPlace = new Vector3(0.13f, 0.12f, 0.2f);

        private readonly PoseInterval poseInterval = new PoseInterval();

        [SerializeField, Tooltip("The settings hold the materials, the methods and the set-up.")]
        private SimilarityStudySettings? settings;

        private GameObject pair = null!;
        private MaskingNoise noise = null!;
        private XrRig rig = null!;
        private bool isRefused;

        /// <summary>The materials, the methods and the set-up. Set them before the component wakes.</summary>
        public SimilarityStudySettings? Settings { get => settings; set => settings = value; }

        /// <summary>The name under which the place of the virtual object is kept between sessions; empty to keep
        /// nothing. Set it before the component wakes.</summary>
        public string SaveName { get; set; } = "SimilarityStudy";

        /// <summary>Measures the delay that a method adds to that of the audio block, in ms. A laboratory with a better
        /// measurement replaces it before the component wakes.</summary>
        public Func<StudyMethod, HapticLoadedModel, Task<double>> MeasureInference { get; set; } = MeasureLive;

        public SampleAlignment Alignment { get; private set; } = null!;
        public OperatorView Operator { get; private set; } = null!;

        /// <summary>The session; null before <see cref="Begin"/>.</summary>
        public StudySession? Session { get; private set; }

        /// <summary>The stages of the current trial; null before <see cref="Begin"/>.</summary>
        public SimilarityProcedure? Procedure { get; private set; }

        /// <summary>The delay that all methods get; null before <see cref="Begin"/>.</summary>
        public EqualDelay? Delay { get; private set; }

        /// <summary>The methods' models; null where the settings cannot be used.</summary>
        public MethodModels? Models { get; private set; }
        public RatingPanel Panel { get; private set; } = null!;
        public TextMesh Instruction { get; private set; } = null!;

        /// <summary>The object in the place of the real sample; null where the settings cannot be used.</summary>
        public StudyObject Real { get; private set; } = null!;

        /// <summary>The virtual object beside it; null where the settings cannot be used.</summary>
        public StudyObject Virtual { get; private set; } = null!;
        public HapticOutput Output { get; private set; } = null!;

        /// <summary>Why the study cannot begin or continue; null when nothing is wrong.</summary>
        public string? Problem => Operator.Problem;

        /// <summary>Whether all is loaded, measured and aligned, so that <see cref="Begin"/> can be called.</summary>
        public bool CanBegin => !isRefused && Session == null && WhatIsMissing() == null;

        /// <summary>The tracked pen; before it was tracked for the first time, the mouse pen.</summary>
        public HapticStylus Pen => rig.PenInUse!;

        /// <summary>Begins or resumes a participant's log, and waits for the operator's first Next. When it fails, it
        /// sets <see cref="Problem"/>, and can be called again.</summary>
        /// <param name="participant">The number of the participant, from 1.</param>
        public void Begin(int participant)
        {
            if (isRefused || Session != null)
            {
                return;
            }
            try
            {
                string? missing = noise.Problem ?? WhatIsMissing();
                if (missing != null)
                {
                    throw new StudyException(missing);
                }
                StudyLog log = OpenLog(participant);
                Session = new StudySession(log);
                Alignment.HasButtons = false;
                Procedure = SimilarityProcedure.Create(Session, this);
                Operator.Session = Session;
                Operator.Problem = null;
            }
            catch (StudyException refusal)
            {
                Operator.Problem = refusal.Message;
            }
        }

        /// <inheritdoc/>
        public override void Sketch()
        {
            if (settings != null)
            {
                Vector3 size = settings.sampleMetres;
                var down = new Vector3(0f, -0.5f * size.y, 0f);
                SceneSketch.DrawBox(down, size, StudyObject.Grey);
                SceneSketch.DrawBox(settings.virtualMetres + down, size, StudyObject.Grey);
            }
        }

        private void Awake()
        {
            // Before the first trial, the pen feels by the model of the project's settings, if they name one.
            if (Model == null && settings != null)
            {
                Model = settings.methods.Select(each => each.model).FirstOrDefault(each => each != null);
            }
            UseModelIfNoneIsSet();
            Camera view = View!;
            Quaternion facing = view.transform.rotation;
            // The scene is built even without settings, so that the operator can read the problem.
            SimilarityStudySettings chosen = settings != null
                ? settings
                : ScriptableObject.CreateInstance<SimilarityStudySettings>();
            Output = chosen.AddOutput(view.gameObject, out noise);
            rig = XrRig.Create(view);
            rig.MousePen = MousePen.Create(view);
            rig.MousePen.Stylus.Output = Output;
            rig.AddPen(chosen.penHand).Stylus!.Output = Output;
            Instruction = SceneObjects.AddText("Please wait.", InstructionPlace, facing);
            Panel = RatingPanel.Create(PanelPlace, facing, chosen.penHand);
            Operator = gameObject.AddComponent<OperatorView>();
            Operator.Output = Output;
            Operator.Detail = Detail;
            Operator.Begin = Begin;
            Operator.Advice = number => settings == null
                ? "" : StudyLog.NumbersLeftOut(settings.Folder, StudyKind.Similarity, number);
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
                Alignment.SetSample(settings.sampleMetres, settings.plateUnderVirtual);
                Models = new MethodModels(settings, MeasureInference);
                Alignment.HasButtons = true;
            }
            catch (StudyException refusal)
            {
                Stop(refusal);
            }
        }

        private void Update()
        {
            poseInterval.Add(Time.unscaledDeltaTime);
            PauseWhenTheModelFails();
            if (isRefused || Models == null || Models.IsReady)
            {
                return;
            }
            try
            {
                Models.Update();
            }
            catch (StudyException refusal)
            {
                Stop(refusal);
            }
        }

        /// <summary>Pauses the session when the method's model has failed, because the participant would not rate the
        /// method. </summary>
        private void PauseWhenTheModelFails()
        {
            string? method = Procedure != null && Procedure.Stage != TrialStage.Waiting ? Session!.Trial!.Method : null;
            string? problem = method != null ? Models!.Of(method).Problem : null;
            if (problem != null)
            {
                Session!.PauseHere();
                Operator.Problem = $"method \"{method}\": {problem}; restart the application; the session continues " +
                    "with this trial";
            }
        }

        private void OnDestroy()
        {
            if (Procedure != null)
            {
                Destroy(Procedure.gameObject);
            }
            Models?.Dispose();
        }

        private void Stop(StudyException refusal)
        {
            isRefused = true;
            Operator.Problem = refusal.Message;
        }

        private StudyLog OpenLog(int participant)
        {
            StudyPlan plan = settings!.PlanFor(participant);
            double? milliseconds = EqualDelay.OfInterrupted(settings.Folder, participant);
            if (milliseconds == null && settings.equalDelayMilliseconds > 0f)
            {
                milliseconds = settings.equalDelayMilliseconds;
            }
            Delay = new EqualDelay(DelaysOfMethods(), milliseconds);
            var description = new StudyDescription(plan, settings.ForLog(), Delay.Of(Delay.Slowest))
            {
                IsSimulated = settings.Simulated,
                Build = StudyPlayer.Build(),
                Device = settings.Device(),
                Models = Models!.ForLog(),
            };
            return StudyLog.Open(settings.Folder, description);
        }

        private Dictionary<string, SystemDelay> DelaysOfMethods() => settings!.methods.ToDictionary(
            each => each.name,
            each => new SystemDelay(poseInterval.MedianMilliseconds, Models!.InferenceMilliseconds(each.name),
                StudyPlayer.BlockMilliseconds, settings.DeviceDelayMilliseconds),
            StringComparer.Ordinal);

        private void MakeObjects(SimilarityStudySettings chosen)
        {
            Real = new StudyObject("Left Object", pair.transform, Vector3.zero, chosen.sampleMetres,
                chosen.realHeightMetres, NewTracing(chosen));
            Real.Surface.Material.Effects = HapticEffects.Nothing;
            Virtual = new StudyObject("Right Object", pair.transform, chosen.virtualMetres, chosen.sampleMetres, 0f,
                NewTracing(chosen));
        }

        private static EdgeTracing NewTracing(SimilarityStudySettings chosen) => new EdgeTracing(
            chosen.sampleMetres.x, chosen.sampleMetres.z, chosen.edgeToleranceMetres, chosen.edgeShare);

        private string? WhatIsMissing()
        {
            if (Models == null || !Models.IsReady)
            {
                return Models?.Doing;
            }
            if (!poseInterval.IsMeasured)
            {
                return "measuring the frame rate";
            }
            return settings!.needsAlignment && !Alignment.Alignment.IsAligned
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
                    DescribeStage();
        }

        private string DescribeStage() => Procedure!.Stage switch
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
            HapticModelDelay delay = await model.MeasureDelay(StudyPlayer.OutputRateHz, frames)
                .ConfigureAwait(false);
            // The lead includes one audio block, which the system delay counts already.
            return Math.Max(delay.InferenceMedianMilliseconds, delay.LeadMilliseconds - blockMilliseconds);
        }
    }
}
