#nullable enable
using System.Collections;
using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Model;

namespace HaptoFlow.Studies
{
    /// <summary>A model or exported baseline that a study plays.</summary>
    public readonly struct StudyModel
    {
        /// <param name="sha256">SHA-256 of the file, 64 hexadecimal digits.</param>
        public StudyModel(string method, string file, string sha256) => (Method, File, Sha256) = (method, file, sha256);

        /// <summary>The method's name in the settings; "signal" in the latency study.</summary>
        public string Method { get; }

        /// <summary>The file's name without its folders.</summary>
        public string File { get; }

        /// <summary>SHA-256 of the file, 64 hexadecimal digits.</summary>
        public string Sha256 { get; }
    }

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

        /// <summary>Application, platform and devices of the study.</summary>
        public StudyEnvironment Environment { get; set; } = new StudyEnvironment();

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

        /// <summary>The text of the sidecar.</summary>
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
            document.Add("build", Environment.Build());
            document.Add("device", Environment.Device(Delay));
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

    /// <summary>Application, headset and audio device of a study, for the record. Contains nothing about a
    /// person.</summary>
    public sealed class StudyEnvironment
    {
        /// <summary>Name and version of the application.</summary>
        public string Application { get; set; } = "";

        /// <summary>Unity's version.</summary>
        public string Unity { get; set; } = "";

        /// <summary>HaptoFlow's version.</summary>
        public string Package { get; set; } = "";

        /// <summary>The platform, for example WindowsPlayer.</summary>
        public string Platform { get; set; } = "";

        /// <summary>Name of the headset; empty without one.</summary>
        public string Headset { get; set; } = "";

        /// <summary>Refresh rate of headset or screen in Hz; 0 where unknown.</summary>
        public double RefreshRateHz { get; set; }

        /// <summary>Sample rate of the audio device, in Hz.</summary>
        public int OutputRateHz { get; set; }

        /// <summary>Frames of an audio block.</summary>
        public int BlockFrames { get; set; }

        /// <summary>Origin of the device delay.</summary>
        public DeviceDelaySource DeviceDelaySource { get; set; }

        /// <summary>How the delay was measured, or the basis of the estimate.</summary>
        public string DeviceDelayNote { get; set; } = "";

        internal StudyFields Build() => new StudyFields
        {
            { "application", Application }, { "unity", Unity }, { "package", Package }, { "platform", Platform },
        };

        internal StudyFields Device(SystemDelay delay) => new StudyFields
        {
            { "headset", Headset },
            { "refresh_rate_hz", RefreshRateHz },
            { "output_rate_hz", OutputRateHz },
            { "block_frames", BlockFrames },
            { "device_delay_ms", delay.DeviceMilliseconds },
            { "device_delay_source", DeviceDelaySource == DeviceDelaySource.Measured ? "measured" : "estimated" },
            { "device_delay_note", DeviceDelayNote },
        };
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
