#nullable enable
using System;
using HaptoFlow.Model;
using HaptoFlow.Preview;
using HaptoFlow.Recordings;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>Reads the recording, learns from it and renders the result, all in the background; takes over what was
    /// finished. Main thread.</summary>
    internal sealed class NewMaterialSession : IDisposable
    {
        private readonly NewMaterialState state;
        private readonly ComparisonWorker worker = new ComparisonWorker();
        private readonly LatestTask<RecordingFile.Request, RecordingFile> reading;
        private readonly LatestTask<ComparisonRequest, ComparisonResult> comparing;
        private RecordingFile? file;
        private (string Path, float FullScale) asked;
        private (Recording, string Material, bool Matches, int Active, byte[])? compared;
        private (Recording? File, float Speed, float Force) completedOf;
        private HapticLearning? learning;
        private string? failure;

        public NewMaterialSession(NewMaterialState state)
        {
            this.state = state;
            reading = new LatestTask<RecordingFile.Request, RecordingFile>(RecordingFile.Read);
            comparing = new LatestTask<ComparisonRequest, ComparisonResult>(worker.Do);
        }

        /// <summary>As the file has it, with the speed and the force that were entered; null where there is none.
        /// </summary>
        public Recording? Recording { get; private set; }

        /// <summary>As the file has it; null where there is none.</summary>
        public Recording? FromFile => file?.Recording;

        /// <summary>Null until the first is finished.</summary>
        public ComparisonResult? Shown { get; private set; }

        /// <summary>Null while nothing is being learnt.</summary>
        public HapticLearning? Learning => learning;

        /// <summary>Something is being read or rendered.</summary>
        public bool IsBusy => reading.IsBusy || comparing.IsBusy;

        /// <summary>What went wrong, for people; null where nothing did.</summary>
        public string? Problem => file?.Problem ?? failure ?? Shown?.Problem;

        /// <summary>Why nothing can be learnt now; null where something can.</summary>
        /// <param name="model">Null for none.</param>
        public string? Obstacle(HapticModelAsset? model) => model == null
            ? "Choose a model: the project has none."
            : Recording == null
                ? "Choose a recording: a CSV table or a WAV file of ten seconds of one material."
                : !Recording.KnowsMotion
                    ? "Enter the speed and the force at which it was recorded: the file does not say them."
                    : state.Name.Trim().Length == 0 ? "Enter a name." : null;

        /// <summary>Asks for what is set where it is not what was asked for last.</summary>
        /// <param name="model">The model to learn for; null where there is none.</param>
        public void Refresh(HapticModelAsset? model)
        {
            if (asked != (state.Path, state.FullScaleMps2))
            {
                asked = (state.Path, state.FullScaleMps2);
                failure = null;
                Read();
            }
            Complete();
            if (Recording == null || model == null)
            {
                return;
            }
            (Recording, string, bool, int, byte[]) wanted =
                (Recording, state.Material, state.MatchesLevels, state.Active, model.File);
            if (!wanted.Equals(compared))
            {
                compared = wanted;
                comparing.Submit(new ComparisonRequest(model.File, Recording)
                {
                    Material = state.Material,
                    TurnDegrees = LearningReportText.TurnDegrees(state.Report),
                    MatchesLevels = state.MatchesLevels,
                    Active = state.Active,
                });
            }
        }

        /// <summary>Begins to learn; returns at once.</summary>
        public void Learn(HapticModelAsset model)
        {
            if (learning != null || Obstacle(model) != null)
            {
                return;
            }
            failure = null;
            try
            {
                learning = HapticLearning.Start(model.File, Recording!, new LearningOptions
                {
                    Name = state.Name.Trim().ToLowerInvariant(),
                    Category = state.Category.Trim(),
                    Description = state.Description.Trim(),
                    Licence = state.Licence.Trim(),
                });
            }
            catch (HaptoFlowException error)
            {
                failure = error.Message;
            }
        }

        /// <summary>What was learnt before stays.</summary>
        public void Cancel() => learning?.Cancel();

        /// <summary>Takes over what was finished meanwhile.</summary>
        /// <returns>Something else is shown now.</returns>
        public bool Poll()
        {
            try
            {
                RecordingFile? read = reading.Poll();
                if (read != null)
                {
                    Take(read);
                }
                ComparisonResult? result = comparing.Poll();
                Shown = result ?? Shown;
                return PollLearning() || read != null || result != null;
            }
            catch (Exception error)
            {
                // A defect: the window goes on, and says so.
                failure = "The comparison failed: " + error.Message;
                Debug.LogException(error);
                return true;
            }
        }

        /// <summary>Waits until nothing is under way any more; for tests.</summary>
        public void Finish(Action refresh)
        {
            do
            {
                refresh();
                learning?.Wait();
                reading.Wait();
                comparing.Wait();
                Poll();
                refresh();
            }
            while (IsBusy || learning != null);
        }

        /// <summary>Cancels and waits for what is under way: native calls must not outlive the scripts.</summary>
        public void Dispose()
        {
            learning?.Cancel();
            learning?.Wait();
            learning = null;
            reading.Dispose();
            comparing.Dispose();
            worker.Dispose();
        }

        private void Read()
        {
            if (state.Path.Length == 0)
            {
                file = null;
                return;
            }
            reading.Submit(new RecordingFile.Request(
                state.Path, state.FullScaleMps2 > 0f ? state.FullScaleMps2 : (double?)null));
        }

        /// <summary>What the file says of itself fills what nobody entered.</summary>
        private void Take(RecordingFile read)
        {
            file = read;
            Recording? recording = read.Recording;
            if (recording == null)
            {
                return;
            }
            state.Name = state.Name.Length > 0 ? state.Name
                : recording.Label.Length > 0 ? recording.Label : recording.Name.ToLowerInvariant();
            state.Licence = state.Licence.Length > 0 ? state.Licence : recording.Licence;
        }

        private void Complete()
        {
            (Recording?, float, float) wanted = (FromFile, state.SpeedMps, state.ForceNewtons);
            if (wanted.Equals(completedOf))
            {
                return;
            }
            completedOf = wanted;
            Recording = FromFile?.With(state.SpeedMps > 0f ? state.SpeedMps : (double?)null,
                state.ForceNewtons > 0f ? state.ForceNewtons : (double?)null);
        }

        private bool PollLearning()
        {
            if (learning == null || !learning.IsCompleted)
            {
                return learning != null;
            }
            HapticLearning ended = learning;
            learning = null;
            if (ended.Material is { } material)
            {
                state.Change("Material", changed =>
                {
                    changed.Material = material;
                    changed.Report = ended.Report!;
                    changed.Active = 1;
                });
            }
            failure = ended.Problem;
            return true;
        }
    }
}
