#nullable enable
using System;

namespace HaptoFlow.Preview
{
    /// <summary>A stroke as it sounds on a material. Immutable by custom: any thread.</summary>
    internal sealed class PreviewSound
    {
        /// <summary>Of the samples, in Hz.</summary>
        public const int RateHz = 48000;

        /// <summary>The acceleration that is +-1, in m/s^2.</summary>
        public const float FullScaleMps2 = (float)HapticEngineOptions.DefaultFullScaleMps2;

        /// <param name="samples">+-1.</param>
        /// <param name="device">What plays it.</param>
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

        /// <summary>For people: the material, or the device that plays it.</summary>
        public string Title { get; }

        public LabelMix Material { get; }

        public Stroke Stroke { get; }

        /// <summary>+-1, one channel.</summary>
        public float[] Samples { get; }

        public double DurationSeconds => Samples.Length / (double)RateHz;

        /// <summary>Largest magnitude, 0 to 1.</summary>
        public float Peak { get; }

        public double PeakMps2 => FullScaleMps2 * Peak;

        /// <summary>While the tip touches.</summary>
        public double RmsMps2 { get; }
    }
}
