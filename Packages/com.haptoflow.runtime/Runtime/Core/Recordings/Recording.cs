#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;

namespace HaptoFlow.Recordings
{
    /// <summary>One's own recording of a material: acceleration with the motion and force that it was made at.
    /// Immutable by custom: any thread.</summary>
    public sealed class Recording
    {
        internal Recording(string name, double sampleRateHz, int axisCount, float[] accelerationMps2)
        {
            Name = name;
            SampleRateHz = sampleRateHz;
            AxisCount = axisCount;
            AccelerationMps2 = accelerationMps2;
        }

        /// <summary>Of the file, without its ending.</summary>
        public string Name { get; }

        /// <summary>Of the acceleration, 1000 to 192000.</summary>
        public double SampleRateHz { get; }

        /// <summary>1 or 3.</summary>
        public int AxisCount { get; }

        /// <summary>Samples of all axes, one after the other, in m/s^2. Not to be changed.</summary>
        public float[] AccelerationMps2 { get; }

        /// <summary>Two numbers for each sample, in m/s along the surface; null where it is
        /// <see cref="ConstantVelocityMps"/>. Not to be changed.</summary>
        public float[]? VelocityMps { get; internal set; }

        /// <summary>In m/s along the two axes of the surface; null where nobody said, or where it changes.</summary>
        public (double X, double Y)? ConstantVelocityMps { get; internal set; }

        /// <summary>One number for each sample, in N; null where it is <see cref="ConstantForceNewtons"/>. Not to be
        /// changed.</summary>
        public float[]? ForceNewtons { get; internal set; }

        /// <summary>In N; null where nobody said, or where it changes.</summary>
        public double? ConstantForceNewtons { get; internal set; }

        /// <summary>What it is a recording of; empty where nobody said.</summary>
        public string Label { get; internal set; } = "";

        /// <summary>Empty where nobody said.</summary>
        public string Licence { get; internal set; } = "";

        /// <summary>Where it comes from; empty where nobody said.</summary>
        public string Source { get; internal set; } = "";

        /// <summary>What was ignored or mended while reading, a sentence each.</summary>
        public IReadOnlyList<string> Remarks { get; internal set; } = Array.Empty<string>();

        /// <summary>Samples of each axis.</summary>
        public int SampleCount => AccelerationMps2.Length / AxisCount;

        /// <summary>How long it is.</summary>
        public double Seconds => SampleCount / SampleRateHz;

        /// <summary>Speed and force are known for every sample: a material can be learnt from it.</summary>
        public bool KnowsMotion => (VelocityMps != null || ConstantVelocityMps != null) &&
            (ForceNewtons != null || ConstantForceNewtons != null);

        /// <summary>In m/s along the surface's two axes; zero where nobody said.</summary>
        public (double X, double Y) VelocityAt(int sample) => VelocityMps != null
            ? (VelocityMps[2 * sample], VelocityMps[2 * sample + 1])
            : ConstantVelocityMps ?? (0.0, 0.0);

        /// <summary>In N; zero where nobody said.</summary>
        public double ForceAt(int sample) =>
            ForceNewtons != null ? ForceNewtons[sample] : ConstantForceNewtons ?? 0.0;

        /// <summary>The same recording with a speed and a force where the files say none.</summary>
        /// <param name="speedMps">Along the first axis; null to leave it.</param>
        /// <param name="forceNewtons">Null to leave it.</param>
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
                Remarks = Remarks.ToArray(),
            };
        }
    }
}
