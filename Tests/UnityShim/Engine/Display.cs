using System.Collections.Generic;
using UnityShim;

namespace UnityEngine
{
    public struct RefreshRate
    {
        public uint numerator;
        public uint denominator;

        public double value => (double)numerator / denominator;
    }

    public struct Resolution
    {
        public int width { get; set; }
        public int height { get; set; }
        public RefreshRate refreshRateRatio { get; set; }
    }

    public sealed partial class Screen
    {
        public static Resolution currentResolution
        {
            get
            {
                World.RequireMainThread();
                return new Resolution { width = 1920, height = 1080, refreshRateRatio = Displays.Screen };
            }
        }
    }

    public interface ISubsystem
    {
        bool running { get; }

        void Start();

        void Stop();

        void Destroy();
    }

    public interface ISubsystemDescriptor
    {
    }

    public class IntegratedSubsystem : ISubsystem
    {
        public bool running { get; private set; }

        public void Start() => running = true;

        public void Stop() => running = false;

        public void Destroy() => Stop();
    }

    public partial class IntegratedSubsystem<TSubsystemDescriptor> : IntegratedSubsystem
        where TSubsystemDescriptor : ISubsystemDescriptor
    {
    }

    public abstract class IntegratedSubsystemDescriptor : ISubsystemDescriptor
    {
    }

    public class IntegratedSubsystemDescriptor<TSubsystem> : IntegratedSubsystemDescriptor
        where TSubsystem : IntegratedSubsystem
    {
    }

    public static partial class SubsystemManager
    {
        public static void GetSubsystems<T>(List<T> subsystems)
            where T : ISubsystem
        {
            subsystems.Clear();
            foreach (ISubsystem each in Displays.Subsystems)
            {
                if (each is T found)
                {
                    subsystems.Add(found);
                }
            }
        }
    }
}

namespace UnityEngine.XR
{
    public class XRDisplaySubsystemDescriptor : IntegratedSubsystemDescriptor<XRDisplaySubsystem>
    {
    }

    public class XRDisplaySubsystem : IntegratedSubsystem<XRDisplaySubsystemDescriptor>
    {
        internal float? RefreshRateHz;

        public bool TryGetDisplayRefreshRate(out float displayRefreshRate)
        {
            displayRefreshRate = RefreshRateHz ?? 0f;
            return RefreshRateHz.HasValue;
        }
    }
}
