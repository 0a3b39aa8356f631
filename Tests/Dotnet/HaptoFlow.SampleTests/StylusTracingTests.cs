using System;
using System.Linq;
using HaptoFlow.SampleScenes;
using HaptoFlow.Tests;
using HaptoFlow.Tests.Support;
using NUnit.Framework;
using UnityEngine;
using UnityShim;

namespace HaptoFlow.SampleTests
{
    public sealed class StylusTracingTests : SampleTest
    {
        private TracingScene scene = null!;

        [SetUp]
        public void BuildScene()
        {
            FinishLoading();
            scene = Open<TracingScene>("StylusTracing");
        }

        [Test]
        public void TheScenesCameraSeesEveryObject()
        {
            foreach (Exhibit exhibit in Exhibits.All.Skip(1))
            {
                Vector3 pixels = camera.WorldToScreenPoint(exhibit.Position);
                Assert.That(pixels.z, Is.GreaterThan(0f), exhibit.Name);
                Assert.That(pixels.x, Is.InRange(0f, camera.pixelWidth), exhibit.Name);
                Assert.That(pixels.y, Is.InRange(0f, camera.pixelHeight), exhibit.Name);
            }
        }

        [Test]
        public void ThePenTouchesTheObjectUnderTheMouse()
        {
            foreach (Exhibit exhibit in Exhibits.All)
            {
                // There is no object on the front of the table.
                Vector3 place = exhibit.Name == "Table" ? new Vector3(0f, 0f, 0f) : exhibit.Position;
                string touched = Stroke(place);
                Assert.That(touched, Is.EqualTo(exhibit.Label));
            }
        }

        [Test]
        public void ThePressureOfAGraphicsPenSetsTheForce()
        {
            PointAt(new Vector3(0.115f, 0.006f, -0.12f));
            SimulatedInput.PenPressure = 0.25f;
            PlayFor(0.5);
            float light = scene.Pen.Stylus.Contact.ForceNewtons;
            SimulatedInput.PenPressure = 1f;
            PlayFor(0.5);
            Assert.That(light, Is.GreaterThan(0f));
            Assert.That(scene.Pen.Stylus.Contact.ForceNewtons, Is.EqualTo(4f * light).Within(0.05f * light));
        }

        [Test]
        public void AStillPenFeelsTheMovingGrille()
        {
            Press(new Vector3(0.3f, 0.022f, 0.12f), 0.5);
            AudioDevice.Forget();
            float fastest = 0f;
            for (int frame = 0; frame < 2.0 * World.FrameRateHz; ++frame)
            {
                World.Frame();
                fastest = Mathf.Max(fastest, scene.Pen.Stylus.Contact.TangentialVelocity.magnitude);
            }
            Assert.That(scene.Pen.Stylus.Contact.Material!.Label, Is.EqualTo("metal mesh"));
            Assert.That(fastest, Is.EqualTo(0.04f * Mathf.PI).Within(0.05f * 0.04f * Mathf.PI));
            Assert.That(Loudest(), Is.GreaterThan(Audible));
        }

        [Test]
        public void TheBoardShowsTheTouchedLabel()
        {
            StatusBoard board = All<StatusBoard>().Single();
            PlayFor(0.5);
            Assert.That(board.Text, Does.Contain("left mouse button"));
            Stroke(new Vector3(0.115f, 0.006f, -0.12f));
            Assert.That(board.Text, Does.StartWith("rubber: 0."));
        }

        [Test]
        public void TheSamplesModelIsUsedOnlyWhenTheProjectHasNone()
        {
            HapticModelAsset projects = HaptoFlowSettings.Active.Model!;
            HapticModelAsset samples = DefaultModel.Asset();
            Wake<TracingScene>(bootstrap => (bootstrap.View, bootstrap.Model) = (camera, samples));
            Assert.That(HaptoFlowSettings.Active.Model, Is.SameAs(projects));
            HaptoFlowSettings.Active.Model = null;
            Wake<TracingScene>(bootstrap => (bootstrap.View, bootstrap.Model) = (camera, samples));
            Assert.That(HaptoFlowSettings.Active.Model, Is.SameAs(samples));
        }

        /// <summary>Draws a small circle around a place, returns the touched label, and leaves the pen there.</summary>
        private string Stroke(Vector3 place)
        {
            SimulatedInput.MouseButton = false;
            PointAt(place);
            PlayFor(0.3);
            AudioDevice.Forget();
            ulong before = StatisticsOf(scene.Pen.Stylus).Inferences;
            SimulatedInput.MouseButton = true;
            for (int frame = 0; frame < 0.6 * World.FrameRateHz; ++frame)
            {
                double angle = 2.0 * Math.PI * 2.0 * frame / World.FrameRateHz;
                var aside = new Vector3((float)Math.Cos(angle), 0f, (float)Math.Sin(angle));
                PointAt(place + 0.015f * aside);
                World.Frame();
            }
            Assert.That(scene.Pen.Stylus.IsTouching, Is.True, place.ToString());
            Assert.That(Loudest(), Is.GreaterThan(Audible), scene.Pen.Stylus.Contact.Collider.name);
            Assert.That(StatisticsOf(scene.Pen.Stylus).Inferences, Is.GreaterThan(before));
            return scene.Pen.Stylus.Contact.Material!.Label;
        }
    }

    /// <summary>Alignment of the tracing sample's table with a real one, which is 4 cm lower and rotated.</summary>
    public sealed class AlignmentStepTests : SampleTest
    {
        private static readonly Vector3[] Paper =
        {
            new Vector3(-0.1485f, 0f, -0.255f), new Vector3(0.1485f, 0f, -0.255f), new Vector3(-0.1485f, 0f, -0.045f),
        };

        private readonly Vector3 deskPosition = new Vector3(0.05f, -0.04f, 0.02f);
        private readonly Quaternion deskRotation = Quaternion.AngleAxis(12f, Vector3.up);

        [SetUp]
        public void BuildScene()
        {
            FinishLoading();
            Open<TracingScene>("StylusTracing", scene => scene.SaveName = "sample test " + Guid.NewGuid());
        }

        [TearDown]
        public void DeleteTheSavedPose() => Step().Alignment.ForgetSaved();

        [Test]
        public void ThreeTouchedCornersMoveTheTableToThePaperAndTheForceDecidesTouches()
        {
            Hover(0);
            Press("<Keyboard>/a");
            Assert.That(Step().Text, Does.Contain("near left"));
            Assert.That(Marks().Count(mark => mark.activeSelf), Is.EqualTo(1));
            RestOnAll();
            Assert.That(Step().Text, Does.StartWith("Aligned; 0."));
            Assert.That(Marks().Count(mark => mark.activeSelf), Is.Zero);
            Transform exhibits = Step().transform;
            Assert.That(Vector3.Distance(exhibits.position, deskPosition), Is.LessThan(1e-3f));
            Assert.That(Pen().TouchBy, Is.EqualTo(TouchDecision.MeasuredForce));
            // The pen presses the desk while it is tracked 6 mm too high, and then is in the air at the same place.
            Tip(new Vector3(0f, 0.006f, 0.02f), 0.5f);
            PlayFor(0.2);
            Assert.That(Pen().IsTouching, Is.True);
            Assert.That(Pen().Contact.Material!.Label, Is.EqualTo("wood"));
            Tip(new Vector3(0f, 0.006f, 0.02f), 0f);
            PlayFor(0.1);
            Assert.That(Pen().IsTouching, Is.False);
        }

        [Test]
        public void UndoRemovesThePointsAndThenTheAlignment()
        {
            Hover(0);
            Press(Left + "primaryButton");
            Rest(0);
            Assert.That(Step().Alignment.PointsTaken, Is.EqualTo(1));
            Press(Left + "secondaryButton");
            Assert.That(Step().Alignment.PointsTaken, Is.Zero);
            RestOnAll();
            Press("<Keyboard>/u");
            Assert.That(Step().transform.position.magnitude, Is.LessThan(1e-6f));
            Assert.That(Pen().TouchBy, Is.EqualTo(TouchDecision.Geometry));
        }

        private void Hover(int corner)
        {
            Tip(Paper[corner] + new Vector3(0f, 0.05f, 0f), 0f);
            PlayFor(0.1);
        }

        private void RestOnAll()
        {
            for (int corner = 0; corner < 3; ++corner)
            {
                Rest(corner);
            }
        }

        private void Rest(int corner)
        {
            Hover(corner);
            Tip(Paper[corner] + new Vector3(0f, Pen().TipRadiusMetres, 0f), 0.5f);
            PlayFor(0.6);
            Hover(corner);
        }

        /// <summary>Moves the pen's tip to a place on the real desk.</summary>
        private void Tip(Vector3 onDesk, float pressure)
        {
            Track(deskPosition + deskRotation * onDesk);
            SimulatedInput.SetControl(Right + "tip", pressure);
        }

        private static AlignmentStep Step() => All<AlignmentStep>().Single();

        private static HapticStylus Pen() =>
            All<HapticStylus>().Single(pen => pen.isActiveAndEnabled && pen.Force != null);

        private static GameObject[] Marks() => Enumerable.Range(0, Step().transform.childCount)
            .Select(index => Step().transform.GetChild(index).gameObject)
            .Where(child => child.name.StartsWith("Mark", StringComparison.Ordinal)).ToArray();
    }

    /// <summary>The stylus tracing sample on all outputs of the package, one after another in one scene.</summary>
    public sealed class OutputStepTests : SampleTest
    {
        [OneTimeSetUp]
        public void LoadOptionalAssemblies() => OptionalAssemblies.Load();

        [SetUp]
        public void BuildScene()
        {
            ForgetDevices();
            FinishLoading();
            Open<TracingScene>("StylusTracing", scene => scene.SaveName = "");
        }

        [TearDown]
        public void ForgetDevices() => HeldDevices.Reset();

        [Test]
        public void EveryPressSwitchesToTheNextOutputOnly()
        {
            HeldDevices.TakeTouchController();
            XrHand.Right.Take("A controller", true);
            Assert.That(Step().Text, Does.StartWith("Auto Output (O:"));
            Slide();
            Assert.That(Felt(), Is.EqualTo("waveform"), "Auto takes the best that the controller has");
            foreach ((string title, string felt) in new[]
            {
                ("Haptic Output: the audio device, as it is", "audio"),
                ("Controller Waveform Output", "waveform"),
                ("Controller Parametric Output, experimental at Meta", "parametric"),
                ("Motor Output", "motor"),
                ("Auto Output", "waveform"),
            })
            {
                Press("<Keyboard>/o");
                Assert.That(Step().Text, Does.StartWith(title));
                Slide();
                Forget();
                Slide();
                Assert.That(Felt(), Is.EqualTo(felt), title);
            }
        }

        [Test]
        public void EveryPressSwitchesToTheNextProcessingOnly()
        {
            Press("<Keyboard>/o");
            foreach ((string title, HapticEffect? running) in new (string, HapticEffect?)[]
            {
                ("as it is", null),
                ("compensated for a voice coil", HapticEffect.Compensation),
                ("100 ms later", HapticEffect.Delay),
                ("with the exposure guard", HapticEffect.ExposureGuard),
                ("as it is", null),
            })
            {
                Assert.That(Step().Text, Does.Contain(title));
                // The previous processing fades out first.
                Slide();
                HapticEffect[] processors = { HapticEffect.Compensation, HapticEffect.Delay, HapticEffect.ExposureGuard };
                ulong[] before = processors.Select(RunsOf).ToArray();
                Slide();
                for (int index = 0; index < processors.Length; ++index)
                {
                    bool ran = RunsOf(processors[index]) > before[index];
                    // A guard that was switched off measures on, so that it remembers the day.
                    bool expected = processors[index] == running ||
                        (processors[index] == HapticEffect.ExposureGuard && before[index] > 0);
                    Assert.That(ran, Is.EqualTo(expected), $"{title}: {processors[index]}");
                }
                Press("<Keyboard>/p");
            }
        }

        private static string Felt()
        {
            var felt = new[]
            {
                (Name: "audio", Is: Loudest() > Audible),
                (Name: "waveform", Is: OVRInput.Waves.Any(wave => wave.Samples.Any(sample => Math.Abs(sample) > 0.01f))),
                (Name: "parametric", Is: OVRInput.Parametric.Count > 0),
                (Name: "motor", Is: XrHand.Right.Impulses.Count > 0),
            };
            return string.Join(" and ", felt.Where(each => each.Is).Select(each => each.Name));
        }

        private static void Forget()
        {
            AudioDevice.Forget();
            OVRInput.Waves.Clear();
            OVRInput.Parametric.Clear();
            XrHand.Right.Impulses.Clear();
        }

        private static void Slide()
        {
            PointOverTheJute(0.5);
            Assert.That(RightPen().IsTouching, Is.True);
        }

        private static ulong RunsOf(HapticEffect effect) => StatisticsOf(RightPen(), effect).Runs;

        private static OutputStep Step() => All<OutputStep>().Single();
    }
}
