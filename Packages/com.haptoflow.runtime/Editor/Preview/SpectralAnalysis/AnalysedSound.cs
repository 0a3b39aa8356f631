#nullable enable
using System.Threading;

namespace HaptoFlow.Preview
{
    /// <summary>A sound with its spectrum and its spectrogram. Immutable.</summary>
    internal sealed class AnalysedSound
    {
        private AnalysedSound(PreviewSound sound, Spectrum spectrum, Spectrogram spectrogram)
        {
            Sound = sound;
            Spectrum = spectrum;
            Spectrogram = spectrogram;
        }

        public PreviewSound Sound { get; }

        public Spectrum Spectrum { get; }

        public Spectrogram Spectrogram { get; }

        /// <exception cref="System.OperationCanceledException">The token was cancelled.</exception>
        public static AnalysedSound Of(PreviewSound sound, CancellationToken token) =>
            new AnalysedSound(sound, Spectrum.Of(sound, token), Spectrogram.Of(sound, token));
    }
}
