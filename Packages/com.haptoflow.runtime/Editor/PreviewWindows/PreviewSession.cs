#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Model;
using HaptoFlow.Preview;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>Requests previews of the window's state in the background, holds the latest. Main thread.</summary>
    internal sealed class PreviewSession : IDisposable
    {
        private readonly TexturePreviewState state;
        private readonly PreviewWorker worker = new PreviewWorker();
        private readonly LatestTask<PreviewRequest, PreviewResult> task;
        private (StrokePreset, StrokeSettings, DrawnPoint[])? strokeSource;
        private Stroke stroke = DrawnStroke.Of(Array.Empty<DrawnPoint>());
        private (int Version, PreviewModel Model, int Measurement, PreviewRelief? Relief)? requested;
        private bool requestedSketch;
        private PreviewRelief? relief;
        private HapticModelAsset? modelAsset;
        private int measurement = 1;
        private string? failure;

        public PreviewSession(TexturePreviewState state)
        {
            this.state = state;
            task = new LatestTask<PreviewRequest, PreviewResult>(worker.Do);
        }

        public PreviewModel Model { get; private set; } = PreviewModel.Of(null);

        /// <summary>The latest result; null until the first is finished.</summary>
        public PreviewResult? Shown { get; private set; }

        public bool IsBusy => task.IsBusy;

        /// <summary>True if the result belongs to the present state and is not a sketch.</summary>
        public bool IsFinal => Shown != null && !IsBusy && !Shown.Request.IsSketch;

        /// <summary>Why there is no sound; null if there is one, or will be.</summary>
        public string? Problem => Model.Problem ?? failure ?? Shown?.Problem;

        /// <summary>What keeps the chosen relief from being previewed, beside a sound; null for nothing.</summary>
        public string? Remark => state.Relief != null && !state.Relief.IsBaked
            ? $"{state.Relief.name} has no heights: the stroke goes over an even surface."
            : null;

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

        /// <summary>Submits a request if the state has changed since the last one.</summary>
        /// <param name="asset">The model to preview; null for none.</param>
        /// <param name="isDragging">True while a control is dragged: a sketch is rendered until it is released.</param>
        public void Refresh(HapticModelAsset? asset, bool isDragging)
        {
            HapticModelAsset? present = asset != null ? asset : null;
            if (!ReferenceEquals(present, modelAsset) || (present != null && present.File != Model.File))
            {
                modelAsset = present;
                Model = PreviewModel.Of(present);
            }
            (int, PreviewModel, int, PreviewRelief?) current = (state.Version, Model, measurement, Relief());
            bool same = current.Equals(requested);
            if (same && (!requestedSketch || isDragging))
            {
                return;
            }
            requested = current;
            requestedSketch = isDragging && !same;
            task.Submit(Request());
        }

        /// <summary>Takes the finished result.</summary>
        /// <returns>True if there is a new result or problem.</returns>
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
                // An unexpected exception is a defect; the window shows it and stays usable.
                failure = "The preview failed: " + error.Message;
                Debug.LogException(error);
            }
            return true;
        }

        public void Finish()
        {
            while (task.IsBusy)
            {
                task.Wait();
                Poll();
            }
        }

        /// <summary>Times the tiers again with the next request.</summary>
        public void MeasureAgain() => ++measurement;

        /// <summary>Blocks until the running request ends: native calls must not outlive a domain reload.</summary>
        public void Dispose()
        {
            task.Dispose();
            worker.Dispose();
        }

        /// <summary>The chosen relief as it is now: its Inspector, a script or a bake may have changed it since it was
        /// requested.</summary>
        private PreviewRelief? Relief()
        {
            ReliefHeights? heights = state.Relief != null ? state.Relief.Heights : null;
            if (heights == null)
            {
                return relief = null;
            }
            bool isSame = relief != null && ReferenceEquals(relief.Heights, heights) &&
                relief.Share.Equals(state.Relief!.Share);
            return isSame ? relief : relief = new PreviewRelief(state.Relief!.name, heights, state.Relief.Share);
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
                Relief = Relief(),
                Device = state.Device,
                IsSketch = requestedSketch,
                Measurement = measurement,
            };
        }
    }

    /// <summary>Labels and tiers of a model. Main thread.</summary>
    internal sealed class PreviewModel
    {
        private PreviewModel(byte[] file, ModelHeader? header, string? problem)
        {
            File = file;
            Problem = problem;
            Labels = header?.Labels.Select(label => label.Name).ToArray() ?? Array.Empty<string>();
            Tiers = header == null ? Array.Empty<string>() : PreviewQualities.Tiers(header);
            DefaultTier = header?.TierOf(HapticQuality.Standard).Name ?? "standard";
        }

        /// <summary>Empty without a model.</summary>
        public byte[] File { get; }

        /// <summary>In the model's order; empty if it cannot be read.</summary>
        public IReadOnlyList<string> Labels { get; }

        /// <summary>Names of the tiers that an engine plays at one of its fixed qualities.</summary>
        public IReadOnlyList<string> Tiers { get; }

        public string DefaultTier { get; }

        /// <summary>The name itself if the model has such a tier, else its default. A window's state may name a tier of
        /// another model.</summary>
        public string TierOrDefault(string name) => Tiers.Contains(name) ? name : DefaultTier;

        /// <summary>Why the model cannot be previewed; null if it can.</summary>
        public string? Problem { get; }

        public static PreviewModel Of(HapticModelAsset? asset)
        {
            if (asset == null)
            {
                return new PreviewModel(Array.Empty<byte>(), null,
                    "There is no model to preview. Choose one above or in Project Settings > HaptoFlow, or reinstall " +
                    "the package, which contains one.");
            }
            try
            {
                return new PreviewModel(asset.File, asset.Header, null);
            }
            catch (HaptoFlowException error)
            {
                return new PreviewModel(
                    asset.File, null, $"The model {asset.name} cannot be used: {error.Message}.");
            }
        }
    }
}
