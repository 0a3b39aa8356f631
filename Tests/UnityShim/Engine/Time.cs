using UnityShim;

namespace UnityEngine
{
    public class Time
    {
        public static float time => (float)Clock.Seconds;
        public static double timeAsDouble => Clock.Seconds;
        public static float deltaTime => (float)(Clock.InFixedStep ? Clock.FixedStepSeconds : Clock.DeltaSeconds);
        public static double unscaledTimeAsDouble => Clock.UnscaledSeconds;
        public static double realtimeSinceStartupAsDouble => Clock.UnscaledSeconds;
        public static float unscaledDeltaTime => (float)Clock.UnscaledDeltaSeconds;
        public static double fixedTimeAsDouble => Clock.FixedSeconds;
        public static double fixedUnscaledTimeAsDouble => Clock.FixedUnscaledSeconds;
        public static float fixedDeltaTime
        {
            get => (float)Clock.FixedStepSeconds;
            set => Clock.FixedStepSeconds = value;
        }

        public static float timeScale
        {
            get => (float)Clock.Scale;
            set => Clock.Scale = value;
        }

        public static int frameCount => Clock.Frames;
        public static bool inFixedTimeStep => Clock.InFixedStep;
    }
}
