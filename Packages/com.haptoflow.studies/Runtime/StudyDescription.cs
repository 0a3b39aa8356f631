#nullable enable
using System.Collections;
using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Model;

namespace HaptoFlow.Studies
{
    /// <summary>A model or exported baseline that a study plays.</summary>
    /// <param name="Method">The method's name in the settings; "signal" in the latency study.</param>
    /// <param name="File">The file's name without its folders.</param>
    /// <param name="Sha256">SHA-256 of the file, 64 hexadecimal digits.</param>
    public sealed record StudyModel(string Method, string File, string Sha256);

    /// <summary>The contents of a sidecar that are known before the session.</summary>
    public sealed class StudyDescription
    {
        /// <param name="plan">The participant's plan.</param>
        /// <param name="settings">The study's own settings; a session can be resumed only with the same ones.</param>
        /// <param name="delay">The parts of the system's delay at the start.</param>
        public StudyDescription(StudyPlan plan, StudyFields settings, SystemDelay delay) =>
            (Plan, Settings, Delay) = (plan, settings, delay);

        /// <summary>The participant's plan.</summary>
        public StudyPlan Plan { get; }

        /// <summary>The study's own settings.</summary>
        public StudyFields Settings { get; }

        /// <summary>The parts of the system's delay at the start.</summary>
        public SystemDelay Delay { get; }

        /// <summary>True where no person took part; reports state it.</summary>
        public bool IsSimulated { get; set; }

        /// <summary>Application and platform: <see cref="StudyPlayer.Build"/>.</summary>
        public StudyFields Build { get; set; } = new StudyFields();

        /// <summary>Headset, audio device and its delay: <see cref="StudySettings.Device"/>.</summary>
        public StudyFields Device { get; set; } = new StudyFields();

        /// <summary>The models that generated the vibration.</summary>
        public IReadOnlyList<StudyModel> Models { get; set; } = new StudyModel[0];

        /// <summary>The fields that must be unchanged when a session is resumed.</summary>
        internal StudyFields Fixed() => new StudyFields
        {
            { "study", Plan.Kind.Name },
            { "participant", Plan.Participant },
            { "seed", Plan.Seed },
            { "simulated", IsSimulated },
            { "settings", Settings },
            { "models", Models.Select(each => new StudyFields
            {
                { "method", each.Method }, { "file", each.File }, { "sha256", each.Sha256 },
            }).ToArray() },
            { "plan", Plan.Trials.Select(Entry).ToArray() },
        };

        internal string Sidecar(SidecarState state)
        {
            var document = new StudyFields { { "format", SidecarState.Format }, { "version", SidecarState.Version } };
            foreach (KeyValuePair<string, object?> member in Fixed())
            {
                if (member.Key == "seed")
                {
                    document.Add("session", state.Session);
                }
                if (member.Key == "settings")
                {
                    AddState(document, state);
                }
                document.Add(member.Key, member.Value);
            }
            return JsonText.Of(document) + "\n";
        }

        private void AddState(StudyFields document, SidecarState state)
        {
            document.Add("created", state.Created);
            document.Add("finished", state.IsFinished);
            document.Add("resumptions", state.ResumedAtTrials.Count);
            document.Add("resumed_at_trials", state.ResumedAtTrials.ToArray());
            document.Add("build", Build);
            document.Add("device", Device);
            document.Add("delay", new StudyFields
            {
                { "pose_interval_ms", Delay.PoseIntervalMilliseconds },
                { "inference_ms", Delay.InferenceMilliseconds },
                { "block_ms", Delay.BlockMilliseconds },
                { "device_ms", Delay.DeviceMilliseconds },
            });
        }

        private StudyFields Entry(PlannedTrial trial)
        {
            var entry = new StudyFields();
            foreach (string column in Plan.Kind.PlannedColumns)
            {
                entry.Add(column, StudyKind.Planned(trial, column));
            }
            return entry;
        }
    }

    /// <summary>Origin of the value for the delay between the audio callback and the hand.</summary>
    public enum DeviceDelaySource
    {
        /// <summary>Assumed; logs and reports state it.</summary>
        Estimated,

        /// <summary>Measured with an oscilloscope or an accelerometer on this set-up.</summary>
        Measured,
    }

    /// <summary>Ordered keys and values of a sidecar: texts, numbers, booleans, lists of them, or further fields. Use a
    /// collection initialiser.</summary>
    public sealed class StudyFields : IEnumerable<KeyValuePair<string, object?>>
    {
        private readonly List<KeyValuePair<string, object?>> members = new List<KeyValuePair<string, object?>>();

        /// <summary>Adds a key with its value.</summary>
        public void Add(string key, object? value) => members.Add(new KeyValuePair<string, object?>(key, value));

        /// <inheritdoc/>
        public IEnumerator<KeyValuePair<string, object?>> GetEnumerator() => members.GetEnumerator();

        IEnumerator IEnumerable.GetEnumerator() => members.GetEnumerator();
    }
}
