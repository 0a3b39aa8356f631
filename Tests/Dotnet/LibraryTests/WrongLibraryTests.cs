using System;
using System.Diagnostics;
using System.IO;
using System.Linq;
using System.Reflection;
using System.Runtime.CompilerServices;
using System.Runtime.InteropServices;
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

    /// <summary>Stands in for the native library.</summary>
    internal static unsafe class StubLibrary
    {
        private static readonly string Folder = Path.Combine(Path.GetTempPath(), $"haptoflow-stub-{Guid.NewGuid():N}");
        private static IntPtr stub;

        /// <summary>Calls of other functions than those of agreement since <see cref="Become"/>.</summary>
        public static int Calls => ((delegate* unmanaged[Cdecl]<int>)Export("stub_calls"))();

        /// <summary>Gives the library a version, and the structs of the C# with one size changed.</summary>
        public static void Become(string version, string changed = "", int bytes = 0)
        {
            fixed (byte* text = NativeCall.Utf8(version))
            {
                ((delegate* unmanaged[Cdecl]<byte*, void>)Export("stub_become"))(text);
            }
            var add = (delegate* unmanaged[Cdecl]<byte*, uint, void>)Export("stub_add_struct");
            foreach (string name in LibraryAgreement.Structs.Keys.Where(name => name != changed || bytes != 0))
            {
                fixed (byte* text = NativeCall.Utf8(name))
                {
                    add(text, (uint)(name == changed ? bytes : LibraryAgreement.Structs[name]));
                }
            }
        }

        public static void Delete() => Directory.Delete(Folder, true);

        private static IntPtr Export(string name) => NativeLibrary.GetExport(stub, name);

        /// <summary>Compiles and loads it, or ignores the tests where there is no C compiler.</summary>
        public static void Build()
        {
            Directory.CreateDirectory(Folder);
            string file = Path.Combine(Folder, "libstub.so");
            try
            {
                using Process compiler = Process.Start(
                    "cc", new[] { "-shared", "-fPIC", "-o", file, Path.Combine(HereFolder(), "stub.c") });
                compiler.WaitForExit();
                Assert.That(compiler.ExitCode, Is.Zero);
            }
            catch (System.ComponentModel.Win32Exception)
            {
                Assert.Ignore("there is no C compiler `cc`");
            }
            stub = NativeLibrary.Load(file);
        }

        private static string HereFolder([CallerFilePath] string path = "") => Path.GetDirectoryName(path)!;

        [ModuleInitializer]
        internal static void Lead() => NativeLibrary.SetDllImportResolver(typeof(HapticModel).Assembly, Resolve);

        private static IntPtr Resolve(string name, Assembly assembly, DllImportSearchPath? searchPath) =>
            name == "audioplugin_haptoflow" ? stub : IntPtr.Zero;
    }
}
