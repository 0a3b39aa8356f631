using System;
using System.Linq;
using HaptoFlow.Native;
using HaptoFlow.Outputs;
using HaptoFlow.Tests;
using NUnit.Framework;
using UnityEngine;
using UnityShim;

namespace HaptoFlow.WrongLibraryTests
{
    public sealed class WrongLibraryTests : SceneTest
    {
        [OneTimeSetUp]
        public void BuildStub() => StubLibrary.Build();

        [OneTimeTearDown]
        public void DeleteStub() => StubLibrary.Delete();

        [TestCase("0.0.9")]
        [TestCase("99.0.0")]
        [TestCase("")]
        public void ALibraryOfAnotherVersionIsRefusedWithOneSentence(string version)
        {
            StubLibrary.Become(version);
            string sentence = Refusal(() => OnnxRuntime.Open());
            Assert.That(sentence, Does.StartWith("The native library audioplugin_haptoflow is of version " + version));
            Assert.That(sentence, Does.Contain(LibraryAgreement.Version).And.Contain("restart Unity"));
        }

        [Test]
        public void AnotherSizeOfAnyStructIsRefused([Values(-4, 8)] int difference)
        {
            foreach (string name in LibraryAgreement.Structs.Keys)
            {
                int bytes = LibraryAgreement.Structs[name];
                StubLibrary.Become(LibraryAgreement.Version, name, bytes + difference);
                string sentence = Refusal(() => OnnxRuntime.Open());
                Assert.That(sentence, Does.Contain($"has {bytes + difference} bytes in its struct {name}, ").And
                    .Contain($"C# scripts have {bytes}"));
            }
        }

        [Test]
        public void AStructThatTheLibraryDoesNotKnowIsRefused()
        {
            StubLibrary.Become(LibraryAgreement.Version, "haptoflow_learning_options");
            Assert.That(
                Refusal(() => OnnxRuntime.Open()), Does.Contain("how large its struct haptoflow_learning_options is"));
        }

        [Test]
        public void EveryWayIntoTheLibraryIsRefusedBeforeAStructCrosses()
        {
            StubLibrary.Become("0.0.9");
            Refusal(() => OnnxRuntime.Open());
            Refusal(() => HapticModel.Open(DefaultModel.Asset().File));
            Refusal(() => HapticModel.Open("a/path.haptoflow"));
            Refusal(() => new HapticCancellation());
            Refusal(() => new WaveFeatures(0.005, 400));
            Assert.That(StubLibrary.Calls, Is.Zero);
        }

        [Test]
        public void TheSceneRunsOnAndOneErrorSaysWhatDisagrees()
        {
            StubLibrary.Become("0.0.9");
            Board();
            AudioTap tap = Output(out HapticOutput _);
            Circling();
            FinishLoading();
            World.Frames(60);
            Assert.That(tap.Peak(), Is.Zero);
            Assert.That(Haptics.IsReady, Is.False);
            string[] errors = Log.Lines.Where(line => line.Type == LogType.Error).Select(line => line.Text).ToArray();
            Assert.That(errors, Has.Length.EqualTo(1));
            Assert.That(errors[0], Does.Contain("runs without haptics").And.Contain("is of version 0.0.9"));
        }

        /// <summary>The one sentence with which an action is refused.</summary>
        private static string Refusal(Action act)
        {
            var refusal = Assert.Throws<HaptoFlowException>(() => act());
            Assert.That(refusal!.Status, Is.EqualTo(HaptoFlowStatus.LibraryMismatch));
            Assert.That(refusal.Message, Does.EndWith(".").And.Not.Contain("\n"));
            Assert.That(refusal.Message.Split(". "), Has.Length.EqualTo(1));
            return refusal.Message;
        }
    }
}
