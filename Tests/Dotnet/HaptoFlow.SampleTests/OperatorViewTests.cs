using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Reflection;
using HaptoFlow.Studies;
using NUnit.Framework;
using UnityShim;

namespace HaptoFlow.SampleTests
{
    public sealed class OperatorViewTests : SampleTest
    {
        private StudyFolder study = null!;
        private StudySession session = null!;
        private OperatorView view = null!;

        [SetUp]
        public void OpenTheView()
        {
            study = new StudyFolder();
            session = new StudySession(study.Open());
            view = Make("Operator View").AddComponent<OperatorView>();
            view.Session = session;
            view.Detail = () => "turn-on, 50 ms";
            PlayFor(0.3);
        }

        [TearDown]
        public void RemoveTheFolder() => study.Dispose();

        [Test]
        public void TheViewShowsParticipantTrialConditionAndDisk()
        {
            string text = Text();
            Assert.That(text, Does.Contain("participant P07, study latency, trial 1 of 8 (practice)"));
            Assert.That(text, Does.Contain("press Next to begin"));
            Assert.That(text, Does.Contain("turn-on, 50 ms"));
            Assert.That(text, Does.Contain("disk: every answer is saved"));
        }

        [Test]
        public void NextStartsATrialAndPauseInterruptsIt()
        {
            Assert.That(Buttons(), Is.EqualTo(new[] { "Next" }));
            Click("Next");
            Assert.That(session.Phase, Is.EqualTo(StudyPhase.Task));
            Assert.That(Buttons(), Is.EqualTo(new[] { "Pause" }));
            Click("Pause");
            Assert.That((session.Phase, session.Attempt), Is.EqualTo((StudyPhase.Paused, 2)));
            PlayFor(0.3);
            Assert.That(Text(), Does.Contain("attempt 2").And.Contain("Next restarts the trial"));
        }

        [Test]
        public void AdviceOnTheChosenNumberIsShownAndAskedForOnceANumber()
        {
            var asked = new List<int>();
            view.Session = null;
            view.Advice = number =>
            {
                asked.Add(number);
                return number == 3 ? "participant P02 has no log here" : "";
            };
            view.Participant = 2;
            PlayFor(1.0);
            Assert.That(Text(), Does.Not.Contain("NOTE"));
            view.Participant = 3;
            PlayFor(1.0);
            Assert.That(Text(), Does.Contain("NOTE: participant P02 has no log here"));
            Assert.That(asked, Is.EqualTo(new[] { 2, 3 }));
        }

        [Test]
        public void TheOperatorChoosesTheParticipantBeforeASession()
        {
            int begun = 0;
            view.Session = null;
            view.Begin = participant => begun = participant;
            Click("+10");
            Click("+1");
            Click("-10");
            Click("-10");
            Click("+1");
            PlayFor(0.3);
            Assert.That(Text(), Does.Contain("participant P02"));
            view.Problem = "participant 2 has finished this study";
            Click("Begin");
            Assert.That(begun, Is.EqualTo(2));
            Assert.That(Buttons(), Does.Contain("Begin").And.Contain("+1"));
        }

        [Test]
        public void AfterTheLastTrialTheNextParticipantCanBegin()
        {
            view.Begin = _ => { };
            session.Continue();
            while (session.Phase != StudyPhase.Finished)
            {
                session.Ask();
                session.Answer(StudyFolder.Yes());
                session.Continue();
            }
            PlayFor(0.3);
            Assert.That(Text(),
                Does.Contain("all trials are answered").And.Contain("finished").And.Contain("press Begin"));
            Assert.That(Buttons(), Does.Contain("Begin"));
        }

        [Test]
        public void AFullDiskIsShown()
        {
            session.Continue();
            session.Ask();
            study.Files.Failure = new IOException("No space left on device");
            session.Answer(StudyFolder.Yes());
            PlayFor(0.3);
            Assert.That(Text(), Does.Contain("NOT SAVED").And.Contain("No space left on device"));
            Assert.That(Buttons(), Is.Empty);
        }

        [Test]
        public void AProblemStopsTheStudyAndHidesTheButton()
        {
            view.Problem = "the delay level 50 ms cannot be reached";
            PlayFor(0.3);
            Assert.That(Text(), Does.Contain("STOPPED: the delay level 50 ms cannot be reached"));
            Assert.That(Buttons(), Is.Empty);
        }

        [Test]
        public void DrawingUnchangedTextAllocatesNothing()
        {
            World.Frames(60);
            long allocated = long.MaxValue;
            for (int frame = 0; frame < 60; ++frame)
            {
                long start = GC.GetAllocatedBytesForCurrentThread();
                World.Frame();
                allocated = Math.Min(allocated, GC.GetAllocatedBytesForCurrentThread() - start);
            }
            Assert.That(allocated, Is.Zero);
        }


        private string Text() => string.Join(
            "\n", Draw().Where(each => each.Kind == DrawnKind.Label).Select(each => each.Label));

        private string[] Buttons() =>
            Draw().Where(each => each.Kind == DrawnKind.Button).Select(each => each.Label).ToArray();

        private void Click(string caption)
        {
            EditorScreen.Press(caption);
            Draw();
        }

        private IReadOnlyList<Drawn> Draw()
        {
            MethodInfo draw = typeof(OperatorView).GetMethod("OnGUI", BindingFlags.Instance | BindingFlags.NonPublic)!;
            return EditorScreen.Draw((Action)Delegate.CreateDelegate(typeof(Action), view, draw));
        }
    }
}
