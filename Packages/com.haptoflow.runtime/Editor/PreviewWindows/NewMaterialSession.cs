#nullable enable
using System;
using System.Linq;
using System.Threading;
using HaptoFlow.Preview;
using HaptoFlow.Recordings;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>Reads the recording, learns from it and renders the result, all in the background, and holds the latest
    /// results. Main thread.</summary>
    internal sealed class NewMaterialSession : IDisposable
    {
        private readonly NewMaterialState state;
        private readonly ComparisonWorker worker = new ComparisonWorker();
        private readonly LatestTask<RecordingFile.Request, RecordingFile> reading;
        private readonly LatestTask<ComparisonRequest, ComparisonResult> comparing;
        private RecordingFile? file;
        private (string Path, float FullScale) requested;
        private (Recording, string Material, bool Matches, int Active, byte[])? compared;
        private (Recording? File, float Speed, float Force) completedOf;
        private string? failure;
        private string reportOf = "";
        private LearningReport? report;

        public NewMaterialSession(NewMaterialState state)
        {
            this.state = state;
            reading = new LatestTask<RecordingFile.Request, RecordingFile>(RecordingFile.Read);
            comparing = new LatestTask<ComparisonRequest, ComparisonResult>(worker.Do);
        }

        /// <summary>The recording with the speed and the force that were entered; null without one.</summary>
        public Recording? Recording { get; private set; }

        /// <summary>The recording as the file has it; null without one.</summary>
        public Recording? FromFile => file?.Recording;

        /// <summary>The latest comparison; null until the first is finished.</summary>
        public ComparisonResult? Shown { get; private set; }

        /// <summary>The report on the last learning; null before one.</summary>
        public LearningReport? Report
        {
            get
            {
                if (reportOf != state.Report)
                {
                    reportOf = state.Report;
                    report = LearningReport.Read(state.Report);
                }
                return report;
            }
        }

        /// <summary>The running learning; null if none runs.</summary>
        public HapticLearning? Learning { get; private set; }

        /// <summary>True while a recording is read or rendered.</summary>
        public bool IsBusy => reading.IsBusy || comparing.IsBusy;

        /// <summary>An error message; null without an error.</summary>
        public string? Problem => file?.Problem ?? failure ?? Shown?.Problem;

        /// <summary>What is missing before learning can start; null if nothing is.</summary>
        /// <param name="model">Null for none.</param>
        public string? Obstacle(HapticModelAsset? model) => model == null
            ? "Choose a model: the project has none."
            : Recording == null
                ? "Choose a recording: a CSV table or a WAV file of ten seconds of one material."
                : !Recording.KnowsMotion
                    ? "Enter the speed and the force of the recording: the file does not state them."
                    : state.Name.Trim().Length == 0 ? "Enter a name." : null;

        /// <summary>Reads and renders again if the settings have changed since the last call.</summary>
        /// <param name="model">The model to learn for; null for none.</param>
        public void Refresh(HapticModelAsset? model)
        {
            if (requested != (state.Path, state.FullScaleMps2))
            {
                requested = (state.Path, state.FullScaleMps2);
                failure = null;
                Read();
            }
            Complete();
            if (Recording == null || model == null)
            {
                return;
            }
            (Recording, string, bool, int, byte[]) current =
                (Recording, state.Material, state.MatchesLevels, state.Active, model.File);
            if (!current.Equals(compared))
            {
                compared = current;
                comparing.Submit(new ComparisonRequest(model.File, Recording)
                {
                    Material = state.Material,
                    TurnDegrees = Report?.TurnDegrees ?? 0.0,
                    MatchesLevels = state.MatchesLevels,
                    Active = state.Active,
                });
            }
        }

        public void Learn(HapticModelAsset model)
        {
            if (Learning != null || Obstacle(model) != null)
            {
                return;
            }
            failure = null;
            try
            {
                Learning = HapticLearning.Start(model.File, Recording!, new LearningOptions
                {
                    Name = LowerCase(state.Name.Trim()),
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

        /// <summary>Stops learning; an earlier result is kept.</summary>
        public void Cancel() => Learning?.Cancel();

        /// <summary>Takes finished results.</summary>
        /// <returns>True if the window must be drawn again.</returns>
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
                // An unexpected exception is a defect; the window shows it and stays usable.
                failure = "The comparison failed: " + error.Message;
                Debug.LogException(error);
                return true;
            }
        }

        /// <summary>Blocks until nothing runs any more; for tests.</summary>
        public void Finish(Action refresh)
        {
            do
            {
                refresh();
                Learning?.Wait();
                reading.Wait();
                comparing.Wait();
                Poll();
                refresh();
            }
            while (IsBusy || Learning != null);
        }

        /// <summary>Cancels everything and blocks until it ends, because native calls must not outlive a domain reload.
        /// </summary>
        public void Dispose()
        {
            Learning?.Cancel();
            Learning?.Wait();
            Learning = null;
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

        /// <summary>Without the capitals that the library refuses; it keeps others, and so does its own name of a
        /// recording.</summary>
        private static string LowerCase(string name) =>
            string.Concat(name.Select(each => each >= 'A' && each <= 'Z' ? char.ToLowerInvariant(each) : each));

        /// <summary>Fills empty settings from the file.</summary>
        private void Take(RecordingFile read)
        {
            file = read;
            Recording? recording = read.Recording;
            if (recording == null)
            {
                return;
            }
            state.Name = state.Name.Length > 0 ? state.Name : recording.MaterialName;
            state.Licence = state.Licence.Length > 0 ? state.Licence : recording.Licence;
        }

        private void Complete()
        {
            (Recording?, float, float) current = (FromFile, state.SpeedMps, state.ForceNewtons);
            if (current.Equals(completedOf))
            {
                return;
            }
            completedOf = current;
            Recording = FromFile?.With(state.SpeedMps > 0f ? state.SpeedMps : (double?)null,
                state.ForceNewtons > 0f ? state.ForceNewtons : (double?)null);
        }

        private bool PollLearning()
        {
            if (Learning == null || !Learning.IsCompleted)
            {
                return Learning != null;
            }
            HapticLearning ended = Learning;
            Learning = null;
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

    /// <summary>The result of reading a recording's file in the background.</summary>
    /// <param name="Recording">Null if the file cannot be read.</param>
    /// <param name="Problem">What is wrong with the file and what was expected; null on success.</param>
    internal sealed record RecordingFile(Recording? Recording, string? Problem)
    {
        /// <summary>Reads a file; the work of a <see cref="LatestTask{TRequest,TResult}"/>.</summary>
        public static RecordingFile Read(Request request, CancellationToken token)
        {
            try
            {
                return new RecordingFile(RecordingReader.Read(request.Path, request.FullScaleMps2), null);
            }
            catch (HaptoFlowException error)
            {
                // The folder is in the window already.
                string folder = System.IO.Path.GetDirectoryName(request.Path) ?? "";
                string message = folder.Length > 0 && error.Message.StartsWith(folder, StringComparison.Ordinal)
                    ? error.Message.Substring(folder.Length + 1)
                    : error.Message;
                return new RecordingFile(null, message + ".");
            }
        }

        /// <summary>A file to read, and its full scale if it was entered.</summary>
        internal sealed record Request(string Path, double? FullScaleMps2);
    }
}
