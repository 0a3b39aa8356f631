#nullable enable
using System;
using HaptoFlow.Recordings;

namespace HaptoFlow.Preview
{
    /// <summary>Converts a recording for comparison with the material learnt from it: one axis, 10 to 1000 Hz, at the
    /// preview's sample rate; and the stroke that it was made with.</summary>
    internal static class RecordingSound
    {
        /// <summary>A longer recording is cut off here.</summary>
        public const double MaximumSeconds = 10.0;

        private const double WorkingHz = 2000.0;
        private const double HighPassHz = 10.0;

        /// <summary>The first <see cref="MaximumSeconds"/> of a recording.</summary>
        public static PreviewSound Of(Recording recording, Stroke stroke)
        {
            int count = Math.Min(recording.SampleCount, (int)(MaximumSeconds * recording.SampleRateHz));
            ReadOnlySpan<float> samples = recording.AccelerationMps2.AsSpan(0, count * recording.AxisCount);
            float[] still = WithoutDrift(WithoutGaps(samples, recording.AxisCount), recording.AxisCount,
                recording.SampleRateHz);
            float[] axis = recording.AxisCount == 1
                ? still
                : AxisCombination.Combined(still, recording.SampleRateHz);
            float[] working = SincResampler.Resampled(axis, recording.SampleRateHz, WorkingHz);
            float[] sound = SincResampler.Resampled(working, WorkingHz, PreviewSound.RateHz);
            for (int index = 0; index < sound.Length; ++index)
            {
                sound[index] /= PreviewSound.FullScaleMps2;
            }
            return new PreviewSound(new LabelMix("recording"), stroke, sound);
        }

        /// <summary>The motion of the recording as one touch over its whole length.</summary>
        /// <param name="turnDegrees">Angle from the recording's first axis to the stroke's.</param>
        public static Stroke StrokeOf(Recording recording, double turnDegrees = 0.0)
        {
            double cosine = Math.Cos(turnDegrees * Math.PI / 180.0);
            double sine = Math.Sin(turnDegrees * Math.PI / 180.0);
            double seconds = Math.Min(recording.Seconds, MaximumSeconds);
            double x = 0.0;
            double y = 0.0;
            return new Stroke(time =>
            {
                int sample = Math.Min(recording.SampleCount - 1, (int)(time * recording.SampleRateHz));
                (double recordedX, double recordedY) = recording.VelocityAt(sample);
                double velocityX = cosine * recordedX + sine * recordedY;
                double velocityY = cosine * recordedY - sine * recordedX;
                x += velocityX / Stroke.UpdateRateHz;
                y += velocityY / Stroke.UpdateRateHz;
                return new StrokeState
                {
                    XMetres = x,
                    YMetres = y,
                    VelocityXMps = velocityX,
                    VelocityYMps = velocityY,
                    ForceNewtons = recording.ForceAt(sample),
                    Touching = true,
                };
            }, seconds, true);
        }

        /// <summary>Removes gravity and slow motion by a first-order high-pass filter, run forward and backward.
        /// </summary>
        private static float[] WithoutDrift(float[] result, int axes, double rateHz)
        {
            double share = 1.0 - Math.Exp(-2.0 * Math.PI * HighPassHz / rateHz);
            for (int axis = 0; axis < axes; ++axis)
            {
                double mean = 0.0;
                for (int index = axis; index < result.Length; index += axes)
                {
                    mean += result[index] * axes / (double)result.Length;
                }
                HighPass(result, axis, axes, mean, share);
                HighPass(result, result.Length - axes + axis, -axes, 0.0, share);
            }
            return result;
        }

        /// <summary>A copy in which gaps repeat the sample before them, which the high-pass filter makes silent.
        /// </summary>
        private static float[] WithoutGaps(ReadOnlySpan<float> samples, int axes)
        {
            float[] result = samples.ToArray();
            for (int index = 0; index < result.Length; ++index)
            {
                if (float.IsNaN(result[index]))
                {
                    result[index] = index < axes ? 0f : result[index - axes];
                }
            }
            return result;
        }

        private static void HighPass(float[] samples, int first, int step, double begin, double share)
        {
            double slow = begin;
            for (int index = first; index >= 0 && index < samples.Length; index += step)
            {
                double fast = samples[index] - slow;
                slow += share * fast;
                // This factor makes the gain 1 at half the sample rate.
                samples[index] = (float)((1.0 - 0.5 * share) * fast);
            }
        }
    }
}
