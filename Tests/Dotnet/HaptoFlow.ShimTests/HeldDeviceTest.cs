using System;
using System.Linq;
using HaptoFlow.Tests;
using HaptoFlow.Tests.Support;
using NUnit.Framework;
using UnityEngine;
using UnityShim;
using Object = UnityEngine.Object;

namespace HaptoFlow.ShimTests
{
    /// <summary>A stylus in the right hand that circles on a wooden board, at 72 frames a second.</summary>
    public abstract class HeldDeviceTest : SceneTest
    {
        protected HapticStylus Pen { get; set; } = null!;

        /// <summary>Loads the optional assemblies, which .NET loads on first use only, unlike Unity.</summary>
        [OneTimeSetUp]
        public void LoadOptionalAssemblies() => OptionalAssemblies.Load();

        [SetUp]
        public void CreateAStylusInTheRightHand()
        {
            ForgetDevices();
            SetFrameRate(72.0);
            FinishLoading();
            Board();
            Pen = Circling();
            Pen.Hand = HapticHand.Right;
        }

        [TearDown]
        public void ForgetDevices()
        {
            HeldDevices.Reset();
            SimulatedInput.Reset();
        }

        internal TOutput Add<TOutput>(Action<TOutput>? prepare = null)
            where TOutput : DeviceOutput
        {
            GameObject owner = Make(typeof(TOutput).Name);
            owner.SetActive(false);
            var output = owner.AddComponent<TOutput>();
            output.Stylus = Pen;
            prepare?.Invoke(output);
            owner.SetActive(true);
            return output;
        }

        internal static void Pause(DeviceOutput output, bool paused) =>
            output.SendMessage("OnApplicationPause", paused);

        internal static TComponent[] All<TComponent>()
            where TComponent : Object => Object.FindObjectsByType<TComponent>(
            FindObjectsInactive.Include, FindObjectsSortMode.None);
    }
}
