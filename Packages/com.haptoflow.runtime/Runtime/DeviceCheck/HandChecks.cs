#nullable enable
using System;
using System.Collections.Generic;
using HaptoFlow.Numerics;
using HaptoFlow.Outputs;

namespace HaptoFlow.DeviceCheck
{
    /// <summary>One route to the device in a hand, after a test wave.</summary>
    internal struct RouteFacts
    {
        public string Hand;
        public string Route;
        public HapticForm Form;

        /// <summary>Name of the device.</summary>
        public string Device;

        /// <summary>The rate that the device reports, in Hz; 0 for one value a frame.</summary>
        public double RateHz;

        /// <summary>Largest buffer, in samples; of waveforms only.</summary>
        public int MaximumSamples;

        public long Submissions;

        /// <summary>Submissions that were refused, or taken only in part.</summary>
        public long Refused;

        public long Gaps;

        public void AddTo(List<CheckLine> lines)
        {
            string rate = RateHz > 0.0 ? FormattableString.Invariant($"{RateHz:0.#} Hz") : "one value a frame";
            string largest = Form == HapticForm.Waveform && MaximumSamples < int.MaxValue
                ? $", buffers of up to {MaximumSamples} samples" : "";
            lines.Add(CheckLine.Of("Devices", $"{Hand} hand, {Route}", Submissions > 0 && Refused == 0 && Gaps == 0,
                $"{Device}: {Form.ToString().ToLowerInvariant()}, {rate}{largest}; " +
                $"{Submissions - Refused} of {Submissions} submissions accepted, {Gaps} gaps",
                Form == HapticForm.Waveform
                    ? "Switch on Queue Submissions of a Controller Waveform Output, or use a Motor Output, and send " +
                        "this page."
                    : "Update the device's firmware and its runtime, use another output, and send this page."));
        }

        /// <summary>For a hand without any device that vibrates.</summary>
        public static CheckLine None(string hand) => CheckLine.Skipped("Devices", hand + " hand, any route",
            "no device that vibrates was found; switch it on and run the check again");
    }

    /// <summary>What a stylus's device reported at rest and during strokes.</summary>
    internal sealed class StylusProbe
    {
        private readonly List<float> restForces = new List<float>();
        private readonly List<float> pressedForces = new List<float>();
        private readonly List<Double3> restTips = new List<Double3>();
        private Double3 lastTip;
        private bool hasTip;
        private int frames;
        private int trackedFrames;
        private int newPoses;
        private double seconds;

        /// <param name="name">Names the stylus on the page.</param>
        /// <param name="pressNewtons">The force at which a touch would begin.</param>
        public StylusProbe(string name, double pressNewtons) => (Name, PressNewtons) = (name, pressNewtons);

        public string Name { get; }

        public double PressNewtons { get; }

        /// <summary>Adds a frame.</summary>
        /// <param name="isPressing">True during strokes, false at rest.</param>
        /// <param name="frameSeconds">Length of the frame.</param>
        /// <param name="tip">Centre of the tip in m; null while it is not tracked.</param>
        /// <param name="forceNewtons">The measured force; null where none is measured.</param>
        public void Add(bool isPressing, double frameSeconds, Double3? tip, float? forceNewtons)
        {
            if (forceNewtons is { } force)
            {
                (isPressing ? pressedForces : restForces).Add(force);
            }
            if (!isPressing)
            {
                if (tip is { } still)
                {
                    restTips.Add(still);
                }
                return;
            }
            ++frames;
            seconds += frameSeconds;
            if (tip is { } moved)
            {
                ++trackedFrames;
                newPoses += hasTip && (moved - lastTip).Length > 0.0 ? 1 : 0;
                lastTip = moved;
                hasTip = true;
            }
        }

        /// <param name="displayHz">The display's rate; 0 where unknown.</param>
        public void AddTo(List<CheckLine> lines, double displayHz)
        {
            AddForce(lines);
            AddTracking(lines, displayHz);
        }

        private void AddForce(List<CheckLine> lines)
        {
            const string Group = "Tip force";
            if (restForces.Count == 0 && pressedForces.Count == 0)
            {
                lines.Add(CheckLine.Skipped(Group, Name, "this stylus measures no force"));
                return;
            }
            (double mean, double deviation, double largest) = Of(restForces);
            lines.Add(CheckLine.Of(Group, Name + " at rest", restForces.Count > 0 && largest < PressNewtons,
                FormattableString.Invariant($"mean {mean:0.000} N, noise {deviation:0.0000} N, ") +
                FormattableString.Invariant($"largest {largest:0.000} N; a touch begins at {PressNewtons:0.000} N"),
                "Raise Press Force and Release Force of the Haptic Stylus, or Minimum Pressure of the pen, above the " +
                "largest value."));
            (double pressedMean, double _, double strongest) = Of(pressedForces);
            int levels = new HashSet<float>(pressedForces).Count;
            lines.Add(CheckLine.Of(Group, Name + " pressed", strongest >= 2.0 * PressNewtons && levels > 2,
                FormattableString.Invariant($"mean {pressedMean:0.000} N, largest {strongest:0.000} N, ") +
                $"{levels} different values",
                "Press harder and run again; otherwise set Newtons At Full Pressure of the pen, or choose another " +
                "source of the tip force."));
        }

        private void AddTracking(List<CheckLine> lines, double displayHz)
        {
            const string Group = "Tracking";
            const double LargestJitterMm = 0.5;
            if (restTips.Count == 0 && trackedFrames == 0)
            {
                lines.Add(CheckLine.Skipped(Group, Name, "this stylus was never tracked"));
                return;
            }
            double rate = seconds > 0.0 ? newPoses / seconds : 0.0;
            double wanted = 0.8 * (displayHz > 0.0 ? displayHz : frames / Math.Max(seconds, 1e-9));
            lines.Add(CheckLine.Of(Group, Name + " rate", trackedFrames >= 0.95 * frames && rate >= wanted,
                FormattableString.Invariant($"{rate:0.0} new poses/s, tracked in {trackedFrames} of {frames} frames"),
                "Keep the pen moving in sight of the headset's cameras during the strokes, and run again in good " +
                "light."));
            double jitter = JitterMillimetres();
            lines.Add(restTips.Count == 0
                ? CheckLine.Skipped(Group, Name + " jitter", "it was not tracked at rest")
                : CheckLine.Of(Group, Name + " jitter", jitter <= LargestJitterMm,
                    FormattableString.Invariant($"{jitter:0.000} mm around the mean at rest"),
                    "Lay the pen on a table in sight of the cameras, and run again in good light."));
        }

        /// <summary>Root mean square of the distances from the mean place.</summary>
        private double JitterMillimetres()
        {
            Double3 mean = default;
            foreach (Double3 each in restTips)
            {
                mean += each * (1.0 / restTips.Count);
            }
            double sum = 0.0;
            foreach (Double3 each in restTips)
            {
                double distance = (each - mean).Length;
                sum += distance * distance;
            }
            return restTips.Count > 0 ? 1000.0 * Math.Sqrt(sum / restTips.Count) : 0.0;
        }

        private static (double Mean, double Deviation, double Largest) Of(List<float> values)
        {
            double sum = 0.0;
            double squares = 0.0;
            double largest = 0.0;
            foreach (float value in values)
            {
                sum += value;
                squares += (double)value * value;
                largest = Math.Max(largest, value);
            }
            double count = Math.Max(1, values.Count);
            double mean = sum / count;
            return (mean, Math.Sqrt(Math.Max(0.0, squares / count - mean * mean)), largest);
        }
    }

    /// <summary>The five questions about what is felt.</summary>
    internal static class FeltQuestions
    {
        private const string Group = "Felt";

        public static IReadOnlyList<(string Name, string Question, string Remedy)> All { get; } = new[]
        {
            ("vibration", "Did you feel a vibration while the tip slid\nover a plate?",
                "Troubleshooting.md: nothing is felt. Check Scene names the output of each stylus."),
            ("stop", "Did it stop as soon as the tip stood still\nor was lifted?",
                "Look at the gaps and late segments above; on a pen, raise Release Force."),
            ("evenness", "Was it free of clicks, gaps and a hum\nthat has nothing to do with the plate?",
                "Switch on Queue Submissions of a Controller Waveform Output, or choose a larger DSP buffer."),
            ("difference", "Did the three plates feel different?",
                "Motors of one frequency show little of a texture: try another output, or an actuator."),
            ("delay", "Did it begin at once, without a delay\nthat you notice?",
                "Wireless audio adds 100 ms and more: use a cable or the controller (studies.md)."),
        };

        /// <param name="answer">Null where the question was skipped.</param>
        public static CheckLine Line(int question, bool? answer)
        {
            (string name, string _, string remedy) = All[question];
            return answer == null
                ? CheckLine.Unanswered(Group, name)
                : CheckLine.Of(Group, name, answer.Value, answer.Value ? "yes" : "no", remedy);
        }
    }
}
