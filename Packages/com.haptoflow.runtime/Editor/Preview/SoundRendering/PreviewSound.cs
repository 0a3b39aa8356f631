#nullable enable
using System;

namespace HaptoFlow.Preview
{
    /// <summary>The vibration of a stroke on a material, as samples. Immutable by convention; any thread.</summary>
    internal sealed class PreviewSound
    {
        /// <summary>Sample rate, in Hz.</summary>
        public const int RateHz = 48000;

        /// <summary>Full scale: acceleration of a sample of 1, in m/s^2.</summary>
        public const float FullScaleMps2 = (float)HapticEngineOptions.DefaultFullScaleMps2;

        /// <param name="samples">In units of <see cref="FullScaleMps2"/>, -1 to 1.</param>
        /// <param name="device">The device that plays them.</param>
        public PreviewSound(
            LabelMix material, Stroke stroke, float[] samples, PreviewDevice device = PreviewDevice.Actuator)
        {
            Title = device == PreviewDevice.Actuator ? material.Title : DeviceRendering.NameOf(device);
            Material = material;
            Stroke = stroke;
            Samples = samples;
            double squares = 0.0;
            long touched = 0;
            for (int index = 0; index < samples.Length; ++index)
            {
                float size = Math.Abs(samples[index]);
                Peak = Math.Max(Peak, size);
                if (stroke.At(index / (double)RateHz).Touching)
                {
                    squares += size * size;
                    ++touched;
                }
            }
            RmsMps2 = FullScaleMps2 * Math.Sqrt(squares / Math.Max(1, touched));
        }

        /// <summary>Title of the material or of the device, for display.</summary>
        public string Title { get; }

        public LabelMix Material { get; }

        public Stroke Stroke { get; }

        /// <summary>One channel in units of <see cref="FullScaleMps2"/>, -1 to 1.</summary>
        public float[] Samples { get; }

        public double DurationSeconds => Samples.Length / (double)RateHz;

        /// <summary>Largest magnitude, 0 to 1.</summary>
        public float Peak { get; }

        public double PeakMps2 => FullScaleMps2 * Peak;

        /// <summary>RMS while the tip touches.</summary>
        public double RmsMps2 { get; }
    }
}
