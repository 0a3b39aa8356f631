#nullable enable
using System;
using System.Collections.Generic;

namespace HaptoFlow.DeviceCheck
{
    /// <summary>The native libraries, as calls that may throw.</summary>
    internal sealed class LibraryFacts
    {
        /// <summary>The library's version.</summary>
        public Func<string> Version { get; set; } = () => "";

        /// <summary>Throws where version or struct sizes differ from the scripts'.</summary>
        public Action RequireAgreement { get; set; } = () => { };

        /// <summary>Throws where ONNX Runtime is missing or too old.</summary>
        public Action OpenOnnxRuntime { get; set; } = () => { };

        /// <summary>Number of structs that cross the border.</summary>
        public int Structs { get; set; }

        public void AddTo(List<CheckLine> lines)
        {
            const string Group = "Library";
            const string Install = "Install the package again and restart; for a player, check that it has a library " +
                "for its platform (installation.md).";
            lines.Add(Tried(Group, "native library", () => "version " + Version(), Install));
            lines.Add(Tried(Group, "struct sizes", () =>
            {
                RequireAgreement();
                return $"{Structs} structs and the version are the same in library and scripts";
            }, Install));
            lines.Add(Tried(Group, "ONNX Runtime", () =>
            {
                OpenOnnxRuntime();
                return "opened";
            }, "Install com.github.asus4.onnxruntime 0.4.9, and its libraries for this platform."));
        }

        private static CheckLine Tried(string group, string name, Func<string> attempt, string remedy)
        {
            try
            {
                return CheckLine.Of(group, name, true, attempt(), remedy);
            }
            catch (Exception error)
            {
                return CheckLine.Of(group, name, false, error.Message, remedy);
            }
        }
    }

    /// <summary>What the runtime finds only by attributes, which code stripping and IL2CPP may drop.</summary>
    internal struct AttributeFacts
    {
        /// <summary>Names of the registered routes to devices: their methods run by an attribute.</summary>
        public IReadOnlyList<string> Routes;

        /// <summary>True where the project has Unity's XR module, which brings two routes.</summary>
        public bool ExpectsRoutes;

        /// <summary>True where the settings are the project's, or the scene's, with a model.</summary>
        public bool HasModel;

        /// <summary>The first word that the library reported by a managed callback; empty where none came.</summary>
        public string Callback;

        /// <summary>Why learning ended before a callback came; null where it did not.</summary>
        public string? CallbackProblem;

        /// <summary>Why no callback could be tried; null where it was.</summary>
        public string? CallbackSkipped;

        public void AddTo(List<CheckLine> lines)
        {
            const string Group = "Attributes and stripping";
            string listed = Routes.Count > 0 ? string.Join(", ", Routes) : "none";
            lines.Add(Routes.Count == 0 && !ExpectsRoutes
                ? CheckLine.Skipped(Group, "routes to devices", "the project has no package with a route to a device")
                : CheckLine.Of(Group, "routes to devices", Routes.Count > 0, listed,
                    "Lower Managed Stripping Level in the player's settings and tell us: methods with " +
                    "RuntimeInitializeOnLoadMethod did not run."));
            lines.Add(CheckLine.Of(Group, "settings and model", HasModel, HasModel ? "found" : "no model",
                "Create settings in Project Settings > HaptoFlow and build again."));
            const string Call = "callback from the library";
            lines.Add(CallbackSkipped != null
                ? CheckLine.Skipped(Group, Call, CallbackSkipped)
                : CheckLine.Of(Group, Call, Callback.Length > 0,
                    Callback.Length > 0 ? $"\"{Callback}\"" : CallbackProblem ?? "none came",
                    "Materials cannot be learnt in this player; learn them in the editor and tell us: " +
                    "MonoPInvokeCallback was not recognised."));
        }
    }

    /// <summary>A further loading of the settings' model.</summary>
    internal struct ModelFacts
    {
        /// <summary>Why it failed; null where it did not.</summary>
        public string? Problem;

        /// <summary>Time from the request until it could be used, in s.</summary>
        public double Seconds;

        public IReadOnlyList<string> Labels;
        public IReadOnlyList<string> Tiers;

        public void AddTo(List<CheckLine> lines)
        {
            const string Group = "Model";
            const double LongestSeconds = 10.0;
            string remedy = Problem != null
                ? "Import the model again; troubleshooting.md names every message."
                : "Load it before the first touch (Haptics.Prepare), or choose a cheaper quality.";
            lines.Add(CheckLine.Of(Group, "loading", Problem == null && Seconds <= LongestSeconds,
                Problem ?? FormattableString.Invariant($"{Seconds:0.00} s, goal {LongestSeconds:0} s"), remedy));
            lines.Add(CheckLine.Of(Group, "labels", Labels.Count > 0, $"{Labels.Count}: {string.Join(", ", Labels)}",
                "Choose a model with labels in Project Settings > HaptoFlow."));
            lines.Add(CheckLine.Of(Group, "tiers", Tiers.Count > 0, $"{Tiers.Count}: {string.Join(", ", Tiers)}",
                "Choose a model with tiers in Project Settings > HaptoFlow."));
        }
    }
}
