using HaptoFlow.Native;
using HaptoFlow.Tests.Support;
using NUnit.Framework;

namespace HaptoFlow.RepositoryTests
{
    /// <summary>Base class of tests with the real library and the shipped model, which is opened once.</summary>
    public abstract class OpenModelTest
    {
        protected OnnxRuntime runtime = null!;
        protected HapticModel model = null!;

        [OneTimeSetUp]
        public void Open()
        {
            runtime = OnnxRuntime.Open();
            model = HapticModel.Open(RepositoryFiles.DefaultModel);
        }

        private protected HapticEngine EngineWithoutWorker(HapticCancellation? cancellation = null) => new HapticEngine(
            runtime, model, new HapticEngineOptions
            {
                Quality = HapticQuality.Draft, WithoutWorker = true, FixedLeadMs = 8.0, Seed = 1,
                Cancellation = cancellation,
            });

        private protected static ContactState Sliding(uint touch) => new ContactState
        {
            Touching = true,
            TouchCounter = touch,
            Material = LabelBlend.Of(1),
            FirstVelocityMps = 0.05f,
            ForceNewtons = 0.6f,
        };

        [OneTimeTearDown]
        public void Close()
        {
            model.Dispose();
            runtime.Dispose();
        }
    }
}
