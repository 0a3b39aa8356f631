#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;

namespace HaptoFlow.Recordings
{
    /// <summary>A recording of a material: acceleration with its motion and force. Treat it as immutable: any
    /// thread.</summary>
    public sealed class Recording
    {
        internal Recording(string name, double sampleRateHz, int axisCount, float[] accelerationMps2)
        {
            Name = name;
            SampleRateHz = sampleRateHz;
            AxisCount = axisCount;
            AccelerationMps2 = accelerationMps2;
        }

        /// <summary>Name of the file without extension.</summary>
        public string Name { get; }

        /// <summary>Sample rate of the acceleration, 1000 to 192000 Hz.</summary>
        public double SampleRateHz { get; }

        /// <summary>Number of axes, 1 or 3.</summary>
        public int AxisCount { get; }

        /// <summary>Samples of all axes, interleaved, in m/s^2; NaN in the recording's gaps. Do not modify.</summary>
        public float[] AccelerationMps2 { get; }

        /// <summary>Two velocity components per sample, in m/s along the surface, NaN in gaps; null where <see
        /// cref="ConstantVelocityMps"/> applies. Do not modify.</summary>
        public float[]? VelocityMps { get; internal set; }

        /// <summary>Velocity in m/s along the two axes of the surface; null where unknown or not constant.</summary>
        public (double X, double Y)? ConstantVelocityMps { get; internal set; }

        /// <summary>Force per sample, in N, NaN in gaps; null where <see cref="ConstantForceNewtons"/> applies. Do not
        /// modify.</summary>
        public float[]? ForceNewtons { get; internal set; }

        /// <summary>Force in N; null where unknown or not constant.</summary>
        public double? ConstantForceNewtons { get; internal set; }

        /// <summary>Name of the recorded material; empty where unknown.</summary>
        public string Label { get; internal set; } = "";

        /// <summary>Licence of the recording; empty where unknown.</summary>
        public string Licence { get; internal set; } = "";

        /// <summary>Origin of the recording; empty where unknown.</summary>
        public string Source { get; internal set; } = "";

        /// <summary>What a material learnt from this recording is called where nobody names it: the label or else the
        /// file's name, in lower case.</summary>
        public string MaterialName { get; internal set; } = "";

        /// <summary>What a material's provenance says of the recording.</summary>
        internal string Provenance { get; set; } = "";

        /// <summary>What was ignored or corrected during reading, one sentence each.</summary>
        public IReadOnlyList<string> Remarks { get; internal set; } = Array.Empty<string>();

        /// <summary>Number of samples per axis.</summary>
        public int SampleCount => AccelerationMps2.Length / AxisCount;

        /// <summary>Duration in seconds.</summary>
        public double Seconds => SampleCount / SampleRateHz;

        /// <summary>True where speed and force are known for every sample, so that a material can be learnt from
        /// it.</summary>
        public bool KnowsMotion => (VelocityMps != null || ConstantVelocityMps != null) &&
            (ForceNewtons != null || ConstantForceNewtons != null);

        /// <summary>Velocity in m/s along the surface's two axes; zero where unknown.</summary>
        public (double X, double Y) VelocityAt(int sample) => VelocityMps != null
            ? (Known(VelocityMps[2 * sample]), Known(VelocityMps[2 * sample + 1]))
            : ConstantVelocityMps ?? (0.0, 0.0);

        /// <summary>Force in N; zero where unknown.</summary>
        public double ForceAt(int sample) =>
            ForceNewtons != null ? Known(ForceNewtons[sample]) : ConstantForceNewtons ?? 0.0;

        private static double Known(float value) => float.IsNaN(value) ? 0.0 : value;

        /// <summary>A copy with a speed and a force where the files contain none.</summary>
        /// <param name="speedMps">Speed along the first axis; null to leave it unknown.</param>
        /// <param name="forceNewtons">Force in N; null to leave it unknown.</param>
        public Recording With(double? speedMps, double? forceNewtons)
        {
            bool needsVelocity = VelocityMps == null && ConstantVelocityMps == null && speedMps.HasValue;
            bool needsForce = ForceNewtons == null && ConstantForceNewtons == null && forceNewtons.HasValue;
            return new Recording(Name, SampleRateHz, AxisCount, AccelerationMps2)
            {
                VelocityMps = VelocityMps,
                ConstantVelocityMps = needsVelocity ? (speedMps!.Value, 0.0) : ConstantVelocityMps,
                ForceNewtons = ForceNewtons,
                ConstantForceNewtons = needsForce ? forceNewtons!.Value : ConstantForceNewtons,
                Label = Label,
                Licence = Licence,
                Source = Source,
                MaterialName = MaterialName,
                Provenance = Provenance,
                Remarks = Remarks.ToArray(),
            };
        }
    }
}
