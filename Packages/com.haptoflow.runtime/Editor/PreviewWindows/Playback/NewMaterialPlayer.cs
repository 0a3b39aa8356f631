#nullable enable
using System;
using System.Collections.Generic;
using HaptoFlow.Preview;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>Plays the recording or the result of the New Material window. Main thread.</summary>
    internal sealed class NewMaterialPlayer : SoundPlayer
    {
        private readonly NewMaterialState state;
        private readonly NewMaterialSession session;

        public NewMaterialPlayer(NewMaterialState state, NewMaterialSession session) =>
            (this.state, this.session) = (state, session);

        public bool IsAvailable => Speaker.IsAvailable;

        /// <summary>Gain of both sounds, at which the louder one nearly reaches full scale.</summary>
        public override float Gain => RaisedPeak / Mathf.Max(1e-6f, Peak);

        protected override IReadOnlyList<AnalysedSound> Sounds => session.Shown?.Sounds ?? Array.Empty<AnalysedSound>();

        protected override int Index => Math.Min(state.Active, Math.Max(0, Sounds.Count - 1));

        protected override (bool Raises, bool Loops) Mode => (true, state.Loops);

        protected override bool IsFinal => !session.IsBusy;
    }
}
