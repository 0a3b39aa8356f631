#nullable enable
using System.Globalization;
using HaptoFlow.Studies;

namespace HaptoFlow.Samples.LatencyStudy
{
    /// <summary>The lines that the operator reads about this study.</summary>
    public static class OperatorLines
    {
        /// <summary>The condition of a trial, and its delay with the parts.</summary>
        public static string OfTrial(PlannedTrial trial, SystemDelay system, float artificialMilliseconds) =>
            string.Format(CultureInfo.InvariantCulture, "{0}, {1} ms in all = system {2} + artificial {3:0.0}",
                trial.Condition, trial.DelayMilliseconds, system, artificialMilliseconds);

        /// <summary>Whether the device delay was measured or estimated, and how.</summary>
        public static string OfDevice(LatencyStudySettings settings) =>
            settings.DeviceDelaySource == DeviceDelaySource.Measured
                ? $"device delay measured: {settings.DeviceDelayNote}"
                : $"device delay ESTIMATED, not measured: {settings.DeviceDelayNote}";

        /// <summary>Whether the pen moves, and the delay of its signal as the native library measured it.</summary>
        public static string OfPen(TrialContact contact, in SignalStatistics signal) => string.Format(
            CultureInfo.InvariantCulture,
            "pen {0}; from pose to block, artificial delay included: start {1:0.0} ms, stop {2:0.0} ms",
            contact.IsMoving ? "moves" : "rests", 1000.0 * signal.LastStartLatencySeconds,
            1000.0 * signal.LastStopLatencySeconds);
    }
}
