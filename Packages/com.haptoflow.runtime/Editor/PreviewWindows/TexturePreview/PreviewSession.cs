#nullable enable
using System;
using System.Collections.Generic;
using HaptoFlow.Preview;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>Keeps what is shown in step with what is set: asks for it in the background and takes it over. Main
    /// thread.</summary>
    internal sealed class PreviewSession : IDisposable
    {
        private readonly TexturePreviewState state;
        private readonly PreviewWorker worker = new PreviewWorker();
        private readonly LatestTask<PreviewRequest, PreviewResult> task;
        private (StrokePreset, StrokeSettings, DrawnPoint[])? strokeSource;
        private Stroke stroke = DrawnStroke.Of(Array.Empty<DrawnPoint>());
        private (int Version, PreviewModel Model, int Measurement)? asked;
        private bool askedSketch;
        private HapticModelAsset? modelAsset;
        private int measurement = 1;
        private string? failure;

        public PreviewSession(TexturePreviewState state)
        {
            this.state = state;
            task = new LatestTask<PreviewRequest, PreviewResult>(worker.Do);
        }

        public PreviewModel Model { get; private set; } = PreviewModel.Of(null);

        /// <summary>Null until the first is finished.</summary>
        public PreviewResult? Shown { get; private set; }

        /// <summary>What is set is not shown yet.</summary>
        public bool IsBusy => task.IsBusy;

        /// <summary>What is shown is what is set, with the noise of the seed.</summary>
        public bool IsFinal => Shown != null && !IsBusy && !Shown.Request.IsSketch;

        /// <summary>Why nothing sounds; null where something does, or will.</summary>
        public string? Problem => Model.Problem ?? failure ?? Shown?.Problem;

        public Stroke Stroke
        {
            get
            {
                (StrokePreset, StrokeSettings, DrawnPoint[]) source = (state.Preset, state.Settings, state.Drawn);
                if (!source.Equals(strokeSource))
                {
                    strokeSource = source;
                    stroke = state.Preset == StrokePreset.Drawn
                        ? DrawnStroke.Of(state.Drawn)
                        : PresetStrokes.Make(state.Preset, state.Settings);
                }
                return stroke;
            }
        }

        /// <summary>Asks for what is set where it is not what was asked for last.</summary>
        /// <param name="asset">The model to preview; null where there is none.</param>
        /// <param name="held">A control is held down: a sketch will do until it is released.</param>
        public void Refresh(HapticModelAsset? asset, bool held)
        {
            HapticModelAsset? present = asset != null ? asset : null;
            if (!ReferenceEquals(present, modelAsset) || (present != null && present.File != Model.File))
            {
                modelAsset = present;
                Model = PreviewModel.Of(present);
            }
            (int, PreviewModel, int) wanted = (state.Version, Model, measurement);
            bool same = wanted.Equals(asked);
            if (same && (!askedSketch || held))
            {
                return;
            }
            asked = wanted;
            askedSketch = held && !same;
            task.Submit(Request());
        }

        /// <summary>Takes over what was finished meanwhile.</summary>
        /// <returns>Something else is shown now.</returns>
        public bool Poll()
        {
            try
            {
                PreviewResult? result = task.Poll();
                if (result == null)
                {
                    return false;
                }
                Shown = result;
                failure = null;
            }
            catch (Exception error)
            {
                // A defect: the window goes on, and says so.
                failure = "The preview failed: " + error.Message;
                Debug.LogException(error);
            }
            return true;
        }

        /// <summary>Waits until what was asked for is shown.</summary>
        public void Finish()
        {
            while (task.IsBusy)
            {
                task.Wait();
                Poll();
            }
        }

        /// <summary>Measures the milliseconds anew with the next request.</summary>
        public void MeasureAgain() => ++measurement;

        /// <summary>Waits for what is under way: native calls must not outlive the scripts.</summary>
        public void Dispose()
        {
            task.Dispose();
            worker.Dispose();
        }

        private PreviewRequest Request()
        {
            IReadOnlyList<LabelMix> mixes = state.Mixes(Model.Labels);
            return new PreviewRequest(Model.File, Stroke, mixes)
            {
                Sliders = SliderCatalog.Of(modelAsset).Sliders,
                Active = state.PlayedIndex,
                Tier = Model.TierOrDefault(state.Tier),
                Seed = unchecked((ulong)state.Seed),
                Effects = state.Effects,
                Device = state.Device,
                IsSketch = askedSketch,
                Measurement = measurement,
            };
        }
    }
}
