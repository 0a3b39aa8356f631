#nullable enable
using System.Threading;

namespace HaptoFlow.Preview
{
    /// <summary>A sound with its spectrum and its spectrogram. Immutable.</summary>
    internal sealed record AnalysedSound(PreviewSound Sound, Spectrum Spectrum, Spectrogram Spectrogram)
    {
        /// <exception cref="System.OperationCanceledException">The token was cancelled.</exception>
        public static AnalysedSound Of(PreviewSound sound, CancellationToken token) =>
            new AnalysedSound(sound, Spectrum.Of(sound, token), Spectrogram.Of(sound, token));
    }
}
