using HaptoFlow.Native;
using HaptoFlow.Tests.Support;
using NUnit.Framework;

namespace HaptoFlow.RepositoryTests
{
    /// <summary>Tests through the real library that share the shipped model, opened once.</summary>
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

        [OneTimeTearDown]
        public void Close()
        {
            model.Dispose();
            runtime.Dispose();
        }
    }
}
