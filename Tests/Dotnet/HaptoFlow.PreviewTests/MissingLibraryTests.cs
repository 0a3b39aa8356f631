using System;
using System.Reflection;
using System.Runtime.Loader;
using System.Threading;
using HaptoFlow.Preview;
using NUnit.Framework;

namespace HaptoFlow.PreviewTests
{
    /// <summary>Loads a second copy of the assemblies, for which no resolver finds the native libraries.</summary>
    public sealed class MissingLibraryTests
    {
        [Test]
        public void AMissingNativeLibraryIsReported()
        {
            var context = new AssemblyLoadContext("without native libraries", true);
            context.LoadFromAssemblyPath(typeof(HapticModel).Assembly.Location);
            Assembly copy = context.LoadFromAssemblyPath(typeof(PreviewWorker).Assembly.Location);
            Type Twin(Type type) => copy.GetType(type.FullName!, true)!;

            object settings = Activator.CreateInstance(Twin(typeof(StrokeSettings)), 0.1, 1.0, 0.0, 0.3, 0.3)!;
            object stroke = Twin(typeof(PresetStrokes)).GetMethod("Make")!.Invoke(null, new[] { 0, settings })!;
            Array materials = Array.CreateInstance(Twin(typeof(LabelMix)), 1);
            materials.SetValue(Activator.CreateInstance(
                Twin(typeof(LabelMix)), "wood", "", 0f, "", null, 1f, 0f), 0);
            object request = Activator.CreateInstance(
                Twin(typeof(PreviewRequest)), ModelFiles.Default, stroke, materials)!;
            object worker = Activator.CreateInstance(Twin(typeof(PreviewWorker)))!;
            object result = Twin(typeof(PreviewWorker)).GetMethod("Do")!
                .Invoke(worker, new[] { request, CancellationToken.None })!;

            var problem = (string?)Twin(typeof(PreviewResult)).GetProperty("Problem")!.GetValue(result);
            Assert.That(problem, Does.Contain("native library").And.Contain("install the packages"));
        }
    }
}
