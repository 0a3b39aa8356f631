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

        [OneTimeTearDown]
        public void Close()
        {
            model.Dispose();
            runtime.Dispose();
        }
    }
}
