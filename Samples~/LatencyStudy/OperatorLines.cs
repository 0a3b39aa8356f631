#nullable enable
using System.Globalization;
using HaptoFlow.Studies;

namespace HaptoFlow.Samples.LatencyStudy
{
    /// <summary>What the operator reads of this study, line by line.</summary>
    public static class OperatorLines
    {
        /// <summary>The condition, and the delay with its parts.</summary>
        public static string OfTrial(PlannedTrial trial, SystemDelay system, float artificialMilliseconds) =>
            string.Format(CultureInfo.InvariantCulture, "{0}, {1} ms in all = system {2} + artificial {3:0.0}",
                trial.Condition, trial.DelayMilliseconds, system, artificialMilliseconds);

        /// <summary>Where the device delay is known from.</summary>
        public static string OfDevice(LatencyStudySettings settings) =>
            settings.DeviceDelaySource == DeviceDelaySource.Measured
                ? $"device delay measured: {settings.DeviceDelayNote}"
                : $"device delay ESTIMATED, not measured: {settings.DeviceDelayNote}";

        /// <summary>What the pen does, and how late its signal was by the library's own count.</summary>
        public static string OfPen(TrialContact contact, in SignalStatistics signal) => string.Format(
            CultureInfo.InvariantCulture,
            "pen {0}; from pose to block, artificial delay included: start {1:0.0} ms, stop {2:0.0} ms",
            contact.IsMoving ? "moves" : "rests", 1000.0 * signal.LastStartLatencySeconds,
            1000.0 * signal.LastStopLatencySeconds);
    }
}
