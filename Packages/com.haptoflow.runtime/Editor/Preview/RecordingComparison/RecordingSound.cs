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

        /// <summary>The first <see cref="MaximumSeconds"/> of a recording.</summary>
        public static PreviewSound Of(Recording recording, Stroke stroke)
        {
            float[] sound = RecordingWave.Resampled(
                RecordingWave.Of(recording, MaximumSeconds), RecordingWave.RateHz, PreviewSound.RateHz);
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
    }
}
